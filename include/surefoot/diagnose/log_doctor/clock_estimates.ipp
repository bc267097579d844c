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

SUREFOOT_ONCE ClockProfile clock_profile(const LogFit& fit, std::size_t r, LogFaultKind kind,
                                         const LogDoctorCriteria& criteria) {
  const Recording& recording = fit.bound.recordings[r];
  const bool offset = kind == LogFaultKind::offset, simulated_again = kind == LogFaultKind::time_skew;
  const double count = offset            ? 2 * criteria.most_shift + 1
                       : simulated_again ? criteria.simulated_skews
                                         : criteria.read_skews;
  const auto steps = static_cast<Eigen::Index>(count);
  const double most = offset ? criteria.most_shift * median_interval(recording) : criteria.most_skew;
  ClockProfile profile;
  profile.squares.setZero(static_cast<Eigen::Index>(criteria.blocks), steps);
  profile.counts = profile.squares;
  const double start = recording.time[0];
  for (Eigen::Index a = 0; a < steps; ++a) {
    const double amount = most * (2 * static_cast<double>(a) / static_cast<double>(steps - 1) - 1);
    profile.amounts.push_back(amount);
    Eigen::VectorXd times = recording.time;
    if (simulated_again) {
      const Recording other =
          repaired(fit.bound, recording, {.kind = kind, .amount = amount});
      const Resimulation resimulation = resimulate(fit, r, other);
      if (resimulation.run.finite) add_squares(fit, recording, resimulation.run, times, a, profile);
      continue;
    }
    for (double& t : times) t = offset ? t - amount : start + (t - start) / (1 + amount);
    if (fit.runs[r].finite) add_squares(fit, recording, fit.runs[r], times, a, profile);
  }
  return profile;
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

/// Place of the least error, by the parabola through it and its neighbours; NaN at the edge of the range.
SUREFOOT_ONCE double least_error_at(const std::vector<double>& amounts, const std::vector<double>& errors,
                                    double& least) {
  const auto at = static_cast<std::size_t>(std::min_element(errors.begin(), errors.end()) - errors.begin());
  least = errors[at];
  if (at == 0 || at + 1 == errors.size()) return std::numeric_limits<double>::quiet_NaN();
  const double left = errors[at - 1], right = errors[at + 1], step = amounts[1] - amounts[0];
  const double bend = left - 2 * errors[at] + right;
  if (!(bend > 0)) return amounts[at];
  const double share = 0.5 * (left - right) / bend;
  least -= (left - right) * share / (2 * 2);  // the parabola's lowest point
  return amounts[at] + share * step;
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
  const std::vector<double> errors = errors_without(profile, -1);
  const double step = profile.amounts[1] - profile.amounts[0];
  const double place = std::clamp((amount - profile.amounts[0]) / step, 0.0, static_cast<double>(errors.size() - 1));
  const auto middle = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(place)), 1, errors.size() - 2);
  const double x = place - static_cast<double>(middle);  // on the parabola through the three nearest
  const double rise = 0.5 * (errors[middle + 1] - errors[middle - 1]);
  const double bend = 0.5 * (errors[middle + 1] + errors[middle - 1]) - errors[middle];
  return errors[middle] + x * (rise + x * bend);
}

}  // namespace surefoot::diagnosis
