// Definitions of surefoot/diagnose/log_doctor/clock_faults.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/log_doctor/clock_faults.hpp"
#include "surefoot/diagnose/log_doctor/tails.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE bool has_clocks(const LogFit& fit, const LogDoctorCriteria& criteria) {
  constexpr std::size_t fewest = 3;  // recordings: one that differs, and two that agree
  if (fit.bound.info.kind != SimulatorKind::ode || fit.bound.recordings.size() < fewest) return false;
  for (const Recording& recording : fit.bound.recordings) {
    if (recording.rows() < static_cast<Eigen::Index>(criteria.fewest_rows)) return false;
  }
  return true;
}

/// Variances of estimates, each pooled with the median one: eight blocks alone tell a variance badly.
SUREFOOT_ONCE std::vector<double> pooled_variances(const std::vector<ClockEstimate>& estimates) {
  std::vector<double> variances;
  for (const ClockEstimate& one : estimates) variances.push_back(one.variance);
  const double middle = median_of(variances);
  for (double& variance : variances) variance = std::max(variance, middle);
  return variances;
}

SUREFOOT_ONCE double scatter_by_chance(const std::vector<ClockEstimate>& estimates,
                                       const LogDoctorCriteria& criteria) {
  const std::vector<double> variances = pooled_variances(estimates);
  double weights = 0, mean = 0, sum = 0;
  for (std::size_t r = 0; r < estimates.size(); ++r) {
    if (!estimates[r].usable || !(variances[r] > 0)) return 1;
    weights += 1 / variances[r];
    mean += estimates[r].value / variances[r];
  }
  mean /= weights;
  for (std::size_t r = 0; r < estimates.size(); ++r) {
    sum += (estimates[r].value - mean) * (estimates[r].value - mean) / variances[r];
  }
  const auto count = static_cast<double>(estimates.size());
  return f_tail(sum / (count - 1), count - 1, count * static_cast<double>(criteria.blocks - 1));
}

/// What is left of recordings at their best clocks, relative to the median one and at least 1: what the model misses in a
/// recording shifts its clock, the more the more it is.
SUREFOOT_ONCE std::vector<double> misfits(const std::vector<ClockEstimate>& estimates) {
  std::vector<double> errors;
  for (const ClockEstimate& one : estimates) {
    if (one.usable) errors.push_back(one.error);
  }
  const double middle = median_of(errors);
  std::vector<double> relative;
  for (const ClockEstimate& one : estimates) relative.push_back(middle > 0 ? std::max(one.error / middle, 1.0) : 1.0);
  return relative;
}

SUREFOOT_ONCE double outlier_by_chance(const std::vector<ClockEstimate>& estimates, std::size_t r,
                                       const LogDoctorCriteria& criteria) {
  const std::vector<double> variances = pooled_variances(estimates), misfit = misfits(estimates);
  double weights = 0, mean = 0, squares = 0, within = 0, of_mean = 0, count = 0;
  for (std::size_t o = 0; o < estimates.size(); ++o) {
    if (o == r || !estimates[o].usable) continue;
    const double weight = 1 / misfit[o];
    weights += weight;
    mean += weight * estimates[o].value;
    squares += weight * estimates[o].value * estimates[o].value;
    within += weight * variances[o];
    of_mean += weight * weight * variances[o];
    ++count;
  }
  if (!estimates[r].usable || count < 2) return 1;
  mean /= weights;
  within /= count;
  const double scatter = std::max(squares - weights * mean * mean, 0.0) / (count - 1);
  const double between = std::max(scatter - within, 0.0);  // recordings differ by more than each is known to
  const double own = variances[r] + of_mean / (weights * weights);
  const double others = between * (misfit[r] + 1 / weights), variance = own + others;
  if (!(variance > 0)) return 1;
  // degrees of freedom of a sum of two estimated variances (Welch and Satterthwaite)
  const double blocks = static_cast<double>(criteria.blocks) - 1;
  const double degrees = variance * variance / (own * own / blocks + others * others / (count - 1));
  return t_tail((estimates[r].value - mean) / std::sqrt(variance), degrees);
}

SUREFOOT_ONCE double median_value(const std::vector<ClockEstimate>& estimates) {
  std::vector<double> values;
  for (const ClockEstimate& one : estimates) {
    if (one.usable) values.push_back(one.value);
  }
  return median_of(values);
}

/// Profiles and estimates of all recordings.
struct Clocks {
  std::vector<ClockProfile> profiles;
  std::vector<ClockEstimate> estimates;
};

SUREFOOT_ONCE Clocks measure_clocks(const LogFit& fit, LogFaultKind kind, const LogDoctorInputs& inputs) {
  const std::size_t count = fit.bound.recordings.size();
  Clocks clocks{std::vector<ClockProfile>(count), std::vector<ClockEstimate>(count)};
  inputs.parallel(count, [&](std::size_t r) {
    clocks.profiles[r] = clock_profile(fit, r, kind, inputs.criteria);
    clocks.estimates[r] = clock_estimate(clocks.profiles[r]);
  });
  return clocks;
}

SUREFOOT_ONCE bool is_like_others(const std::vector<ClockEstimate>& estimates, std::size_t r,
                                  const LogDoctorCriteria& criteria) {
  double worst = 0;
  for (std::size_t o = 0; o < estimates.size(); ++o) {
    if (o != r && estimates[o].usable) worst = std::max(worst, estimates[o].error);
  }
  return estimates[r].error <= criteria.decisive * worst;
}

/// The one recording whose clock is off, and by how much its error falls.
struct SingleClock {
  LogFaultKind kind = LogFaultKind::offset;
  std::size_t recording = 0;
  double amount = 0, error = std::numeric_limits<double>::infinity();
};

SUREFOOT_ONCE bool stays_within_a_row(const Recording& one, double rate) {
  return std::abs(rate) * (one.time[one.rows() - 1] - one.time[0]) < median_interval(one);
}

SUREFOOT_ONCE void compare_single(const LogFit& fit, const Clocks& clocks, LogFaultKind kind,
                                  const LogDoctorCriteria& criteria, std::optional<SingleClock>& best) {
  constexpr double kinds = 3;  // of clocks, each of which is tested
  const double common = median_value(clocks.estimates);
  for (std::size_t r = 0; r < clocks.estimates.size(); ++r) {
    const ClockEstimate& one = clocks.estimates[r];
    if (!one.usable || !is_like_others(clocks.estimates, r, criteria)) continue;
    const bool is_rate = kind != LogFaultKind::offset;
    if (is_rate && stays_within_a_row(fit.bound.recordings[r], one.value - common)) continue;
    const double chance =
        outlier_by_chance(clocks.estimates, r, criteria) * static_cast<double>(clocks.estimates.size()) * kinds;
    const double ratio = error_at(clocks.profiles[r], common) / one.error;
    const double least = kind == LogFaultKind::offset ? criteria.decisive : criteria.skew_gain;
    if (!(chance < criteria.significance && ratio > least)) continue;
    if (!best || one.error < best->error) best = SingleClock{kind, r, one.value - common, one.error};
  }
}

SUREFOOT_ONCE std::vector<Recording> with_amounts(const LogFit& fit, LogFaultKind kind,
                                                  const std::vector<double>& amounts) {
  std::vector<Recording> recordings = fit.bound.recordings;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    if (amounts[r] != 0) recordings[r] = repaired(fit.bound, recordings[r], {.kind = kind, .amount = amounts[r]});
  }
  return recordings;
}

/// The model calibrated to recordings whose offsets were taken out.
struct WithoutOffsets {
  LogFit fit;
  std::vector<double> amounts;  // [s]
};

/// The one amount with which the errors of all recordings are least, by the mean of their logarithms.
SUREFOOT_ONCE double common_amount(const Clocks& clocks) {
  const std::vector<double>& amounts = clocks.profiles.front().amounts;
  const double rows_apart = amounts[1] - amounts[0];
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < amounts.size(); ++a) {
    const double amount = amounts.front() + rows_apart * static_cast<double>(a);
    double sum = 0;
    for (const ClockProfile& profile : clocks.profiles) sum += std::log(error_at(profile, amount));
    if (sum < least) best = amount;
    least = std::min(least, sum);
  }
  return best;
}

/// Takes offsets out and calibrates in turn, until neither moves much: each recording's own, or one for all.
SUREFOOT_ONCE WithoutOffsets take_offsets_out(const LogDoctorInputs& inputs, const LogFit& fit, WithoutOffsets start,
                                              bool own) {
  constexpr int rounds = 10;        // parameters that follow a delay make it slow
  constexpr double settled = 0.05;  // of an interval between rows: no offset moves further
  const double interval = median_interval(fit.bound.recordings.front());
  for (int round = 0; round < rounds; ++round) {
    const Clocks left = measure_clocks(start.fit, LogFaultKind::offset, inputs);
    const double common = common_amount(left);
    double move = 0;
    for (std::size_t r = 0; r < start.amounts.size(); ++r) {
      const ClockEstimate& one = left.estimates[r];
      const double more = own && one.usable ? one.value : own ? 0 : common;
      start.amounts[r] += more;
      move = std::max(move, std::abs(more));
    }
    start.fit =
        fit_log(inputs, with_amounts(fit, LogFaultKind::offset, start.amounts), start.fit.hypothesis.parameters);
    if (move < settled * interval) break;
  }
  return start;
}

/// Mean logarithm of how much the mean square errors of recordings fall.
SUREFOOT_ONCE double mean_gain(const LogFit& before, const LogFit& after) {
  double sum = 0;
  for (std::size_t r = 0; r < before.error.size(); ++r) sum += std::log(before.error[r] / after.error[r]);
  return sum / static_cast<double>(before.error.size());
}

SUREFOOT_ONCE ClockFault single_fault(const SingleClock& single, std::size_t recordings) {
  ClockFault fault{single.kind, std::vector<double>(recordings, 0.0)};
  fault.amounts[single.recording] = single.amount;
  return fault;
}

SUREFOOT_ONCE bool beats_other_start(const LogDoctorInputs& inputs, const LogFit& fit, std::size_t r, Recording cured) {
  BoundSimulator freed = fit.bound;
  free_measured_initial_states(freed, {r});
  const Recording& logged = freed.recordings[r];
  cured.initial_scale = logged.initial_scale;
  return mean_square(resimulate(fit, r, logged).residuals, fit.size) >
         inputs.criteria.skew_gain * mean_square(resimulate(fit, r, cured).residuals, fit.size);
}

/// Whether a recording's clock explains it better than a start of its own or, an offset, than parameters of its own
/// would, as physics may ask for that is missing and that it alone shows: friction where motions are small.
SUREFOOT_ONCE bool beats_own_parameters(const LogDoctorInputs& inputs, const LogFit& fit, const SingleClock& single) {
  const std::size_t r = single.recording;
  const Recording cured = repaired(fit.bound, fit.bound.recordings[r], {.kind = single.kind, .amount = single.amount});
  if (single.kind != LogFaultKind::offset) return beats_other_start(inputs, fit, r, cured);
  const LogFit own = fit_log(inputs, {fit.bound.recordings[r]}, fit.hypothesis.parameters);
  return mean_square(resimulate(fit, r, cured).residuals, fit.size) < mean_square(own.residuals.front(), fit.size);
}

/// Offsets that differ between all recordings: the error falls further with each one's own than with a delay that all
/// have in common, and decisively so unless physics is missing.
SUREFOOT_ONCE std::optional<ClockFault> differing_offsets(const LogDoctorInputs& inputs, const LogFit& fit,
                                                          const Clocks& clocks) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  if (!(scatter_by_chance(clocks.estimates, criteria) < criteria.significance)) return std::nullopt;
  const WithoutOffsets logged{fit, std::vector<double>(fit.error.size(), 0.0)};
  WithoutOffsets delayed = take_offsets_out(inputs, fit, logged, false);
  std::optional<SingleClock> single;  // beside a delay that all have in common
  compare_single(delayed.fit, measure_clocks(delayed.fit, LogFaultKind::offset, inputs), LogFaultKind::offset, criteria, single);
  if (single && beats_own_parameters(inputs, delayed.fit, *single)) return single_fault(*single, fit.error.size());
  WithoutOffsets cured = take_offsets_out(inputs, fit, delayed, true);
  WithoutOffsets other = take_offsets_out(inputs, fit, logged, true);
  if (mean_gain(cured.fit, other.fit) > 0) cured = std::move(other);
  for (const double& amount : cured.amounts) {  // the common delay from several starts: no worse a chance for physics
    WithoutOffsets same{cured.fit, std::vector<double>(fit.error.size(), amount)};
    same.fit = fit_log(inputs, with_amounts(fit, LogFaultKind::offset, same.amounts), cured.fit.hypothesis.parameters);
    if (mean_gain(delayed.fit, same.fit) > 0) delayed = std::move(same);
  }
  const double gain = mean_gain(delayed.fit, cured.fit);
  if (!(gain > std::log(criteria.suspect_gain))) return std::nullopt;
  ClockFault fault{LogFaultKind::offset, cured.amounts, gain > std::log(criteria.decisive)};
  const double middle = std::max(median_of(fault.amounts), 0.0);  // a delay; that a machine is early is its clock again
  for (double& amount : fault.amounts) amount -= middle;
  return fault;
}

SUREFOOT_ONCE std::optional<ClockFault> find_clock_fault(const LogDoctorInputs& inputs, const LogFit& fit,
                                                         bool of_one) {
  if (!has_clocks(fit, inputs.criteria)) return std::nullopt;
  std::optional<SingleClock> single;
  const Clocks offsets = measure_clocks(fit, LogFaultKind::offset, inputs);
  compare_single(fit, offsets, LogFaultKind::offset, inputs.criteria, single);
  for (const LogFaultKind kind : {LogFaultKind::output_skew, LogFaultKind::time_skew}) {
    compare_single(fit, measure_clocks(fit, kind, inputs), kind, inputs.criteria, single);
  }
  if (single && beats_own_parameters(inputs, fit, *single)) return single_fault(*single, fit.error.size());
  if (of_one) return std::nullopt;
  return differing_offsets(inputs, fit, offsets);
}

SUREFOOT_ONCE bool clock_explains_more(const LogDoctorInputs& inputs, const LogFit& fit, const FoundFault& columns) {
  const auto clock = find_clock_fault(inputs, fit, /*of_one=*/true);
  const std::size_t r = *columns.recording;
  if (!clock || clock->amounts[r] == 0) return false;
  const auto left = [&](const Repairs& repairs) {
    const Recording version = repaired(fit.bound, fit.bound.recordings[r], repairs);
    return mean_square(resimulate(fit, r, version).residuals, fit.size);
  };
  return left({{.kind = clock->kind, .amount = clock->amounts[r]}}) < left(columns.repairs);
}

}  // namespace surefoot::diagnosis
