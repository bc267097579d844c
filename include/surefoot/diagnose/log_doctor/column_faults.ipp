// Definitions of surefoot/diagnose/log_doctor/column_faults.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// The unit of an output's residuals before its readings are multiplied by something: the same share of its size.
SUREFOOT_INLINE Eigen::VectorXd unit_before(Eigen::VectorXd unit, const Repairs& repairs) {
  for (const LogRepair& repair : repairs) {
    if (repair.kind == LogFaultKind::degrees && !repair.channel.input) unit[repair.channel.index] /= repair.amount;
  }
  return unit;
}

SUREFOOT_INLINE RepairEffect effect_of(const LogFit& fit, std::size_t r, const Repairs& repairs,
                                       const ResidualRows& after) {
  constexpr double least = 1e-12;  // of an output's variance: as good as no error
  const ResidualRows& before = fit.residuals[r];
  double count = 0;
  for (Eigen::Index i = 0; i < after.size(); ++i) count += std::isnan(after.data()[i]) ? 0 : 1;
  RepairEffect effect;
  effect.after = std::max(mean_square(after, fit.size), least);
  effect.log_ratio = std::log(std::max(mean_square(before, unit_before(fit.size, repairs)), least) / effect.after);
  const double gain =
      mean_square(before, unit_before(fit.typical, repairs)) - mean_square(after, fit.typical);
  effect.log_odds = std::isnan(gain) ? 0 : 0.5 * count * independent_share(after, fit.typical) * gain;
  if (std::isnan(effect.log_ratio)) effect.log_ratio = 0;  // both ran away
  return effect;
}

SUREFOOT_INLINE std::vector<Repairs> repairs_to_try(const SimulatorInfo& info) {
  std::vector<Repairs> all;
  Repairs angles, read_angles;
  for (const LogRepair& repair : column_repairs(info)) {
    all.push_back({repair});
    if (repair.kind != LogFaultKind::degrees) continue;
    angles.push_back(repair);
    if (!repair.channel.input) read_angles.push_back(repair);
  }
  if (read_angles.size() > 1) all.push_back(read_angles);
  if (angles.size() > 1 && angles.size() > read_angles.size()) all.push_back(angles);
  return all;
}

/// Finer units of time than seconds [s]: milli-, micro- and nanoseconds.
inline constexpr double time_units[] = {1e-3, 1e-6, 1e-9};

SUREFOOT_INLINE double median_interval(const Recording& recording) {
  std::vector<double> intervals;
  for (Eigen::Index row = 1; row < recording.rows(); ++row) {
    intervals.push_back(recording.time[row] - recording.time[row - 1]);
  }
  return median_of(intervals);
}

/// The time unit that would make the intervals of a recording those of the others, if they are far apart.
SUREFOOT_INLINE std::vector<Repairs> unit_of_time_repairs(const BoundSimulator& bound, std::size_t r) {
  constexpr double alike = 10;  // ratio of intervals that different settings of a logger explain
  if (bound.info.kind != SimulatorKind::ode) return {};
  std::vector<double> others;
  for (std::size_t o = 0; o < bound.recordings.size(); ++o) {
    if (o != r) others.push_back(median_interval(bound.recordings[o]));
  }
  const double ratio = median_interval(bound.recordings[r]) / median_of(others);
  std::vector<Repairs> repairs;
  for (const double unit : time_units) {
    if (ratio > alike && ratio * unit < alike && ratio * unit * alike > 1) {
      repairs.push_back({{.kind = LogFaultKind::time_unit, .amount = unit}});
    }
  }
  return repairs;
}

SUREFOOT_INLINE Recording repaired(const BoundSimulator& bound, Recording recording, const Repairs& repairs) {
  for (const LogRepair& repair : repairs) recording = repaired(bound, recording, repair);
  return recording;
}

/// Repairs of one recording that would cure about as well as the best.
SUREFOOT_INLINE std::vector<Repairs> as_good(const std::vector<Repairs>& tried, const std::vector<RepairEffect>& effects,
                                             std::size_t best, const LogDoctorCriteria& criteria) {
  std::vector<Repairs> also;
  for (std::size_t t = 0; t < tried.size(); ++t) {
    const bool close = effects[t].log_ratio > effects[best].log_ratio - std::log(criteria.decisive) / 2;
    if (t != best && close && effects[t].log_ratio > std::log(criteria.decisive)) also.push_back(tried[t]);
  }
  return also;
}

SUREFOOT_INLINE std::optional<FoundFault> find_fault_of_one(const LogFit& fit, const LogDoctorCriteria& criteria,
                                                            const Parallel& parallel) {
  const std::size_t count = fit.bound.recordings.size();
  if (count < 2) return std::nullopt;
  const std::vector<Repairs> columns = repairs_to_try(fit.bound.info);
  std::vector<std::vector<Repairs>> tried(count, columns);
  std::vector<std::vector<RepairEffect>> effects(count);
  for (std::size_t r = 0; r < count; ++r) {
    const auto times = unit_of_time_repairs(fit.bound, r);
    tried[r].insert(tried[r].end(), times.begin(), times.end());
    effects[r].resize(tried[r].size());
  }
  parallel(count, [&](std::size_t r) {
    for (std::size_t t = 0; t < tried[r].size(); ++t) {
      const Recording version = repaired(fit.bound, fit.bound.recordings[r], tried[r][t]);
      effects[r][t] = effect_of(fit, r, tried[r][t], resimulate(fit, r, version).residuals);
    }
  });
  const double tests = static_cast<double>(count * columns.size());
  const double least_odds = std::log(tests / criteria.significance);
  std::optional<FoundFault> found;
  double best_ratio = 0;
  for (std::size_t r = 0; r < count; ++r) {
    double others_worst = 0;
    for (std::size_t o = 0; o < count; ++o) others_worst = std::max(others_worst, o == r ? 0 : fit.error[o]);
    for (std::size_t t = 0; t < tried[r].size(); ++t) {
      const RepairEffect& effect = effects[r][t];
      if (!(effect.log_odds > least_odds && effect.log_ratio > std::log(criteria.decisive))) continue;
      if (effect.after > criteria.decisive * others_worst) continue;  // still unlike the others
      std::vector<double> of_others;
      for (std::size_t o = 0; o < count; ++o) {
        if (o != r && t < columns.size()) of_others.push_back(effects[o][t].log_ratio);
      }
      if (median_of(of_others) > 0) continue;  // physics that all have in common
      if (found && effect.log_ratio <= best_ratio) continue;
      best_ratio = effect.log_ratio;
      found = FoundFault{tried[r][t], r, as_good(tried[r], effects[r], t, criteria)};
    }
  }
  return found;
}

/// How much less the error of the median recording is, as a logarithm; 0 unless it halves in most recordings.
SUREFOOT_INLINE double common_gain(const LogFit& before, const LogFit& after, const LogDoctorCriteria& criteria) {
  constexpr double least = 1e-12;  // of an output's variance: as good as no error
  std::vector<double> gains;
  double better = 0;
  for (std::size_t r = 0; r < before.error.size(); ++r) {
    const double gain = std::log(std::max(before.error[r], least) / std::max(after.error[r], least));
    gains.push_back(std::isnan(gain) ? 0 : gain);
    better += gains.back() > std::log(criteria.decisive) ? 1 : 0;
  }
  if (better < criteria.most_of * static_cast<double>(gains.size())) return 0;
  return median_of(gains);
}

SUREFOOT_INLINE std::optional<FoundFault> find_fault_of_all(const LogDoctorInputs& inputs, const LogFit& fit) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  if (median_of(fit.error) < criteria.poor_fit) return std::nullopt;
  std::vector<Repairs> tried = repairs_to_try(fit.bound.info);
  if (fit.bound.info.kind == SimulatorKind::ode) {
    for (const double unit : time_units) tried.push_back({{.kind = LogFaultKind::time_unit, .amount = unit}});
  }
  std::vector<double> gains;
  for (const Repairs& repairs : tried) {
    std::vector<Recording> recordings;
    for (const Recording& recording : fit.bound.recordings) {
      recordings.push_back(repaired(fit.bound, recording, repairs));
    }
    gains.push_back(common_gain(fit, fit_log(inputs, std::move(recordings)), criteria));
  }
  const auto best = std::ranges::max_element(gains);
  if (!(*best > 0)) return std::nullopt;
  FoundFault found{tried[static_cast<std::size_t>(best - gains.begin())]};
  for (std::size_t t = 0; t < tried.size(); ++t) {
    if (gains.begin() + static_cast<std::ptrdiff_t>(t) == best) continue;
    if (gains[t] > *best - std::log(criteria.decisive) / 2) found.also.push_back(tried[t]);
  }
  return found;
}

}  // namespace surefoot::diagnosis
