// Definitions of surefoot/diagnose/log_doctor/clock_estimates.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/diagnose/log_doctor/clock_estimates.hpp"
#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// Adds the squared residuals of a simulation that is read at other times to column `a` of the profile.
SUREFOOT_ONCE void add_squares(const LogFit& fit, const Recording& recording, const SimulatedRun& run,
                               const Eigen::VectorXd& times, Eigen::Index a, ClockProfile& profile) {
  const Eigen::Index rows = recording.rows(), blocks = profile.squares.rows();
  Eigen::Index i = 0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double t = std::max(times[row], recording.time[0]);  // at rest before the first row
    while (i + 2 < rows && recording.time[i + 1] < t) ++i;
    if (t > recording.time[i + 1]) continue;
    const double share = (t - recording.time[i]) / (recording.time[i + 1] - recording.time[i]);
    for (Eigen::Index k = 0; k < recording.outputs.rows(); ++k) {
      double off = (1 - share) * run.outputs(k, i) + share * run.outputs(k, i + 1) - recording.outputs(k, row);
      if (fit.bound.wrapped[static_cast<std::size_t>(k)]) off = wrap_angle(off);
      if (!std::isfinite(off)) continue;
      off /= fit.typical[k];
      profile.squares(row * blocks / rows, a) += off * off;
      profile.counts(row * blocks / rows, a) += 1;
    }
  }
}

SUREFOOT_ONCE void with_column(Eigen::MatrixXd& all, Eigen::Index at, const Eigen::MatrixXd& column) {
  Eigen::MatrixXd wider;
  wider.setZero(column.rows(), all.cols() + 1);
  for (Eigen::Index c = 0; c < wider.cols(); ++c) {
    for (Eigen::Index b = 0; b < wider.rows(); ++b) {
      wider(b, c) = c < at ? all(b, c) : c == at ? column(b, 0) : all(b, c - 1);
    }
  }
  all.swap(wider);
}

/// Tries one more amount, in its place among the others.
SUREFOOT_ONCE void add_amount(const LogFit& fit, std::size_t r, LogFaultKind kind, double amount,
                              ClockProfile& profile) {
  const Recording& recording = fit.bound.recordings[r];
  ClockProfile one{{amount}, {}, {}};
  one.squares.setZero(profile.squares.rows(), 1);
  one.counts = one.squares;
  Eigen::VectorXd times = recording.time;
  if (kind == LogFaultKind::time_skew) {
    const Recording other = repaired(fit.bound, recording, {.kind = kind, .amount = amount});
    const Resimulation resimulation = resimulate(fit, r, other);
    if (resimulation.run.finite) add_squares(fit, recording, resimulation.run, times, 0, one);
  } else {
    const double start = recording.time[0];
    for (double& t : times) t = kind == LogFaultKind::offset ? t - amount : start + (t - start) / (1 + amount);
    if (fit.runs[r].finite) add_squares(fit, recording, fit.runs[r], times, 0, one);
  }
  const auto place = std::upper_bound(profile.amounts.begin(), profile.amounts.end(), amount);
  const auto at = static_cast<Eigen::Index>(place - profile.amounts.begin());
  profile.amounts.insert(place, amount);
  with_column(profile.squares, at, one.squares);
  with_column(profile.counts, at, one.counts);
}

/// Mean square errors by amount, without one block (or none: -1).
SUREFOOT_ONCE std::vector<double> errors_without(const ClockProfile& profile, Eigen::Index left_out) {
  std::vector<double> errors;
  for (Eigen::Index a = 0; a < profile.squares.cols(); ++a) {
    double sum = 0, count = 0;
    for (Eigen::Index b = 0; b < profile.squares.rows(); ++b) {
      if (b == left_out) continue;
      sum += profile.squares(b, a);
      count += profile.counts(b, a);
    }
    errors.push_back(count > 0 ? sum / count : std::numeric_limits<double>::infinity());
  }
  return errors;
}

/// Tries amounts halfway to the neighbours of the best, until the error changes so little between them that a parabola
/// describes it: the better the model fits, the narrower is the valley.
SUREFOOT_ONCE void try_between(const LogFit& fit, std::size_t r, LogFaultKind kind, ClockProfile& profile) {
  constexpr int rounds = 10;      // each halves what lies between two amounts
  constexpr double wide = 2;      // times the least error: the neighbours', where the parabola holds
  for (int round = 0; round < rounds; ++round) {
    const std::vector<double> errors = errors_without(profile, -1);
    const auto at = static_cast<std::size_t>(std::min_element(errors.begin(), errors.end()) - errors.begin());
    if (at == 0 || at + 1 == errors.size() || std::max(errors[at - 1], errors[at + 1]) < wide * errors[at]) return;
    const double left = (profile.amounts[at - 1] + profile.amounts[at]) / 2;
    const double right = (profile.amounts[at] + profile.amounts[at + 1]) / 2;
    add_amount(fit, r, kind, left, profile);
    add_amount(fit, r, kind, right, profile);
  }
}

SUREFOOT_ONCE ClockProfile clock_profile(const LogFit& fit, std::size_t r, LogFaultKind kind,
                                         const LogDoctorCriteria& criteria) {
  const bool offset = kind == LogFaultKind::offset, simulated_again = kind == LogFaultKind::time_skew;
  const double count = offset            ? 2 * criteria.most_shift + 1
                       : simulated_again ? criteria.simulated_skews
                                         : criteria.read_skews;
  const auto steps = static_cast<Eigen::Index>(count);
  const double most =
      offset ? criteria.most_shift * median_interval(fit.bound.recordings[r]) : criteria.most_skew;
  ClockProfile profile;
  profile.squares.setZero(static_cast<Eigen::Index>(criteria.blocks), 0);
  profile.counts = profile.squares;
  for (Eigen::Index a = 0; a < steps; ++a) {
    add_amount(fit, r, kind, most * (2 * static_cast<double>(a) / static_cast<double>(steps - 1) - 1), profile);
  }
  if (simulated_again) try_between(fit, r, kind, profile);
  return profile;
}

/// A parabola through three errors, about the middle one.
struct Parabola {
  double rise = 0, bend = 0;  // error = middle + x (rise + x bend)
};

SUREFOOT_ONCE Parabola parabola_at(const std::vector<double>& amounts, const std::vector<double>& errors,
                                   std::size_t middle) {
  const double left = amounts[middle] - amounts[middle - 1], right = amounts[middle + 1] - amounts[middle];
  const double below = (errors[middle] - errors[middle - 1]) / left;
  const double above = (errors[middle + 1] - errors[middle]) / right;
  return {(below * right + above * left) / (left + right), (above - below) / (left + right)};
}

/// Place of the least error, by the parabola through it and its neighbours; NaN at the edge of the range.
SUREFOOT_ONCE double least_error_at(const std::vector<double>& amounts, const std::vector<double>& errors,
                                    double& least) {
  const auto at = static_cast<std::size_t>(std::min_element(errors.begin(), errors.end()) - errors.begin());
  least = errors[at];
  if (at == 0 || at + 1 == errors.size()) return std::numeric_limits<double>::quiet_NaN();
  const Parabola parabola = parabola_at(amounts, errors, at);
  if (!(parabola.bend > 0) || !std::isfinite(parabola.bend)) return amounts[at];
  const double x = -parabola.rise / (2 * parabola.bend);
  least += x * (parabola.rise + x * parabola.bend);
  return amounts[at] + x;
}

SUREFOOT_ONCE ClockEstimate clock_estimate(const ClockProfile& profile) {
  ClockEstimate estimate;
  double ignored = 0;
  estimate.value = least_error_at(profile.amounts, errors_without(profile, -1), estimate.error);
  if (!std::isfinite(estimate.value) || !std::isfinite(estimate.error)) return estimate;
  estimate.usable = true;
  const auto blocks = profile.squares.rows();
  std::vector<double> values;
  double mean = 0;
  for (Eigen::Index b = 0; b < blocks; ++b) {
    double value = least_error_at(profile.amounts, errors_without(profile, b), ignored);
    if (!std::isfinite(value)) value = profile.amounts.back();  // one block decides: hardly known
    values.push_back(value);
    mean += value / static_cast<double>(blocks);
  }
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  estimate.variance = sum * static_cast<double>(blocks - 1) / static_cast<double>(blocks);
  return estimate;
}

SUREFOOT_ONCE double error_at(const ClockProfile& profile, double amount) {
  const std::vector<double>& amounts = profile.amounts;
  const std::vector<double> errors = errors_without(profile, -1);
  const double within = std::clamp(amount, amounts.front(), amounts.back());
  std::size_t middle = 1;  // of the three that are nearest
  while (middle + 2 < amounts.size() && within > (amounts[middle] + amounts[middle + 1]) / 2) ++middle;
  const Parabola parabola = parabola_at(amounts, errors, middle);
  const double x = within - amounts[middle];
  return errors[middle] + x * (parabola.rise + x * parabola.bend);
}

}  // namespace surefoot::diagnosis
