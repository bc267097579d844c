// Definitions of surefoot/diagnose/log_doctor/column_faults.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/log_doctor/column_faults.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Log-likelihood of n independent residuals with this sum of squares: multivariate t, up to what n alone decides.
SUREFOOT_ONCE double log_likelihood(double n, double squares, const SpreadOfSizes& spread) {
  const double unit = spread.degrees * spread.scale * spread.scale;
  return -n / 2 * std::log(unit) - (spread.degrees + n) / 2 * std::log1p(squares / unit);
}

/// What log_likelihood leaves out, which n alone decides.
SUREFOOT_ONCE double log_norm(double n, const SpreadOfSizes& spread) {
  return std::lgamma((spread.degrees + n) / 2) - std::lgamma(spread.degrees / 2) - n / 2 * std::log(std::numbers::pi);
}

SUREFOOT_ONCE double measured_cells(const ResidualRows& residuals) {
  double count = 0;
  for (Eigen::Index i = 0; i < residuals.size(); ++i) count += std::isnan(residuals.data()[i]) ? 0 : 1;
  return count;
}

/// Of a spread: a Cauchy distribution, of which one far off says nothing of the others.
inline constexpr double least_degrees = 1;

SUREFOOT_ONCE SpreadOfSizes spread_of_others(const LogFit& fit, std::size_t r) {
  constexpr double most = 12;   // degrees: sizes that differ by a fifth; few recordings alone cannot tell less
  constexpr double widest = 4;  // scale, and its inverse: the median is not further from the middle of any distribution
  std::vector<double> counts, squares;
  for (std::size_t o = 0; o < fit.residuals.size(); ++o) {
    const double square = mean_square(fit.residuals[o], fit.typical);
    const double n = independent_share(fit.residuals[o], fit.typical) * measured_cells(fit.residuals[o]);
    if (o == r || !(n > 0 && std::isfinite(square))) continue;
    counts.push_back(n);
    squares.push_back(n * square);
  }
  SpreadOfSizes best{most, 1};
  double highest = -std::numeric_limits<double>::infinity();
  for (double degrees = most; degrees >= least_degrees; degrees /= std::numbers::sqrt2) {
    for (double scale = 1 / widest; scale <= widest; scale *= std::sqrt(std::numbers::sqrt2)) {
      double sum = 0;
      for (std::size_t o = 0; o < counts.size(); ++o) {
        sum += log_norm(counts[o], {degrees, scale}) + log_likelihood(counts[o], squares[o], {degrees, scale});
      }
      if (sum > highest) best = {degrees, scale};
      highest = std::max(highest, sum);
    }
  }
  return best;
}

/// Residuals of the outputs that repairs touch; of all where they touch inputs or the time.
SUREFOOT_ONCE ResidualRows touched(ResidualRows residuals, const Repairs& repairs) {
  std::vector<bool> keep(static_cast<std::size_t>(residuals.rows()), false);
  for (const LogRepair& repair : repairs) {
    if (repair.channel.input || repair.other.input || repair.kind == LogFaultKind::time_unit) return residuals;
    keep[static_cast<std::size_t>(repair.channel.index)] = true;
    if (repair.kind == LogFaultKind::swap) keep[static_cast<std::size_t>(repair.other.index)] = true;
  }
  for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
    if (keep[static_cast<std::size_t>(k)]) continue;
    for (Eigen::Index row = 0; row < residuals.cols(); ++row) {
      residuals(k, row) = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return residuals;
}

/// Logarithm of how much denser readings lie after they were multiplied by something (the Jacobian of that change).
SUREFOOT_ONCE double log_density(const ResidualRows& after, const Repairs& repairs) {
  double sum = 0;
  for (const LogRepair& repair : repairs) {
    if (repair.kind != LogFaultKind::degrees || repair.channel.input) continue;
    sum += std::log(std::abs(repair.amount)) * measured_cells(touched(after, {repair}));
  }
  return sum;
}

SUREFOOT_ONCE double log_likelihood_if_unlike(const LogFit& fit, const ResidualRows& residuals, double n) {
  double sum = 0;
  for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
    double cells = 0;
    for (Eigen::Index row = 0; row < residuals.cols(); ++row) cells += std::isnan(residuals(k, row)) ? 0 : 1;
    sum -= cells * std::log(fit.size[k] / fit.typical[k]);
  }
  const double whole = measured_cells(residuals);
  return whole > 0 ? n * (sum / whole - 0.5 * (std::log(2 * std::numbers::pi) + 1)) : 0;
}

SUREFOOT_ONCE RepairEffect effect_of(const LogFit& fit, std::size_t r, const Repairs& repairs,
                                     const ResidualRows& after, const SpreadOfSizes& spread) {
  constexpr double least = 1e-12;  // of an output's variance: as good as no error
  const ResidualRows& before = fit.residuals[r];
  RepairEffect effect;
  effect.after = std::max(mean_square(after, fit.size), least);
  const double touched_after = std::max(mean_square(touched(after, repairs), fit.size), least);
  const double touched_before = mean_square(touched(before, repairs), fit.size);
  effect.log_ratio = std::log(std::max(touched_before, least) / touched_after);
  const double share = independent_share(after, fit.typical), n = share * measured_cells(after);
  const double with = log_likelihood(n, n * mean_square(after, fit.typical), spread);
  const double without = log_likelihood(n, n * mean_square(before, fit.typical), spread);
  const SpreadOfSizes any{least_degrees, 1};  // it may have physics of its own as well
  const double with_any = log_likelihood(n, n * mean_square(after, fit.typical), any) + log_norm(n, any);
  effect.over_unlike = std::max(with + log_norm(n, spread), with_any) - log_likelihood_if_unlike(fit, after, n);
  effect.log_odds = std::isfinite(with) ? with + share * log_density(after, repairs) - without : 0;
  if (std::isnan(effect.log_ratio)) effect.log_ratio = 0;  // both ran away
  return effect;
}

SUREFOOT_ONCE std::vector<Repairs> repairs_to_try(const SimulatorInfo& info) {
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

SUREFOOT_ONCE double median_interval(const Recording& recording) {
  std::vector<double> intervals;
  for (Eigen::Index row = 1; row < recording.rows(); ++row) {
    intervals.push_back(recording.time[row] - recording.time[row - 1]);
  }
  return median_of(intervals);
}

/// How many times as long as those of the other recordings the intervals of one are, by medians.
SUREFOOT_ONCE double ratio_of_intervals(const BoundSimulator& bound, std::size_t r) {
  std::vector<double> others;
  for (std::size_t o = 0; o < bound.recordings.size(); ++o) {
    if (o != r) others.push_back(median_interval(bound.recordings[o]));
  }
  return median_interval(bound.recordings[r]) / median_of(others);
}

/// The time unit that would make the intervals of a recording those of the others, if they are far apart.
SUREFOOT_ONCE std::vector<Repairs> unit_of_time_repairs(const BoundSimulator& bound, std::size_t r) {
  constexpr double alike = 10;  // ratio of intervals that different settings of a logger explain
  if (bound.info.kind != SimulatorKind::ode) return {};
  const double ratio = ratio_of_intervals(bound, r);
  std::vector<Repairs> repairs;
  for (const double unit : time_units) {
    if (ratio > alike && ratio * unit < alike && ratio * unit * alike > 1) {
      repairs.push_back({{.kind = LogFaultKind::time_unit, .amount = unit}});
    }
  }
  return repairs;
}

/// Whether a repair of the unit of time makes the intervals of a recording those of the others: another setting of the
/// logger would hardly be just a thousand times slower.
SUREFOOT_ONCE bool makes_intervals_equal(const BoundSimulator& bound, std::size_t r, const Repairs& repairs) {
  constexpr double close = 1.1;  // ratio, or its inverse: medians of clocks that are not regular
  if (repairs.front().kind != LogFaultKind::time_unit) return false;
  const double ratio = repairs.front().amount * ratio_of_intervals(bound, r);
  return ratio < close && ratio * close > 1;
}

SUREFOOT_ONCE Recording repaired(const BoundSimulator& bound, Recording recording, const Repairs& repairs) {
  for (const LogRepair& repair : repairs) recording = repaired(bound, recording, repair);
  return recording;
}

/// Whether one repair is more likely than another; of two that end a simulation's running away, the closer one.
SUREFOOT_ONCE bool more_likely(const RepairEffect& one, const RepairEffect& other) {
  return one.log_odds != other.log_odds ? one.log_odds > other.log_odds : one.after < other.after;
}

/// Repairs of one recording that are about as likely as the best.
SUREFOOT_ONCE std::vector<Repairs> as_good(const std::vector<Repairs>& tried,
                                           const std::vector<RepairEffect>& effects, std::size_t best,
                                           const LogDoctorCriteria& criteria) {
  std::vector<Repairs> also;
  for (std::size_t t = 0; t < tried.size(); ++t) {
    const bool close = effects[t].log_odds - std::log(criteria.significance) > effects[best].log_odds;
    const bool cures = effects[t].after < criteria.decisive * effects[best].after;
    if (t != best && close && cures && tried[t].size() == 1) also.push_back(tried[t]);
  }
  return also;
}

SUREFOOT_ONCE bool moves_beyond_misfit(const LogFit& fit, std::size_t r, const Repairs& repairs) {
  return holds_for_all(repairs, [&](const LogRepair& repair) {
    if (repair.kind != LogFaultKind::sign || repair.channel.input) return true;
    const Eigen::Index k = repair.channel.index;
    const Eigen::VectorXd readings = surefoot::detail::row_of(fit.bound.recordings[r].outputs, k);
    int count = 0;
    for (const double reading : readings) count += std::isfinite(reading) ? 1 : 0;
    const bool at_the_end = count == 1;  // which is all that is known of how it moved
    return (at_the_end ? root_mean_square(readings) : standard_deviation(readings)) > fit.typical[k];
  });
}

SUREFOOT_ONCE bool is_odd(const LogFit& fit, std::size_t r, const Repairs& repairs) {
  const auto missed = [&](std::size_t recording) {
    return mean_square(touched(fit.residuals[recording], repairs), fit.size);
  };
  std::vector<double> others;
  for (std::size_t o = 0; o < fit.residuals.size(); ++o) {
    if (o != r) others.push_back(missed(o));
  }
  return !(missed(r) < median_of(others));
}

/// Whether a repaired recording is nearer to the others than to what it was, in decades, once the model is calibrated
/// to it as well: before, it may have pulled the parameters away, and physics that is missing makes recordings differ.
SUREFOOT_ONCE bool becomes_like_others(const LogDoctorInputs& inputs, const LogFit& fit, const FoundFault& found) {
  const std::size_t r = *found.recording;
  std::vector<Recording> recordings = fit.bound.recordings;
  recordings[r] = repaired(fit.bound, recordings[r], found.repairs);
  const LogFit again = fit_log(inputs, std::move(recordings), fit.hypothesis.parameters);
  return again.error[r] * again.error[r] <= fit.error[r] * worst_of_others(again.error, r);
}

SUREFOOT_ONCE std::optional<FoundFault> find_fault_of_one(const LogDoctorInputs& inputs, const LogFit& fit,
                                                          std::optional<std::size_t> only) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  const std::size_t count = fit.bound.recordings.size();
  if (count < 2) return std::nullopt;
  const std::vector<Repairs> columns = repairs_to_try(fit.bound.info);
  std::vector<std::vector<Repairs>> tried(count, columns);
  std::vector<std::vector<RepairEffect>> effects(count);
  for (std::size_t r = 0; r < count; ++r) {
    const auto times = unit_of_time_repairs(fit.bound, r);
    append_items(tried[r], times);
    effects[r].resize(tried[r].size());
  }
  inputs.parallel(count, [&](std::size_t r) {
    const SpreadOfSizes spread = spread_of_others(fit, r);
    for (std::size_t t = 0; t < tried[r].size(); ++t) {
      const Recording version = repaired(fit.bound, fit.bound.recordings[r], tried[r][t]);
      effects[r][t] = effect_of(fit, r, tried[r][t], resimulate(fit, r, version).residuals, spread);
    }
  });
  const double tests = static_cast<double>(count * columns.size());
  const double least_odds = std::log(tests * criteria.fault_odds);
  const double likeliest_of = std::log(static_cast<double>(columns.size()));
  std::optional<FoundFault> found, unlike;  // the others, as they are calibrated now
  RepairEffect best, best_unlike;
  for (std::size_t r = only.value_or(0); r < (only ? *only + 1 : count); ++r) {
    const double others_worst = worst_of_others(fit.error, r);
    for (std::size_t t = 0; t < tried[r].size(); ++t) {
      const RepairEffect& effect = effects[r][t];
      const bool equal = makes_intervals_equal(fit.bound, r, tried[r][t]);  // then it is only asked to fit better
      const double odds = equal ? 0 : least_odds, ratio = equal ? 0 : std::log(criteria.decisive);
      if (!(effect.log_odds > odds && effect.log_ratio > ratio)) continue;
      if (!(effect.over_unlike > likeliest_of)) continue;  // it is no recording of this machine, and bends to that
      if (!is_odd(fit, r, tried[r][t]) || !moves_beyond_misfit(fit, r, tried[r][t])) continue;
      std::vector<double> of_others;
      for (std::size_t o = 0; o < count; ++o) {
        if (o != r && t < columns.size()) of_others.push_back(effects[o][t].log_ratio);
      }
      if (median_of(of_others) > 0) continue;  // physics that all have in common
      const bool alike = effect.after <= criteria.decisive * others_worst;
      std::optional<FoundFault>& one = alike ? found : unlike;
      RepairEffect& so_far = alike ? best : best_unlike;
      if (one && !more_likely(effect, so_far)) continue;
      so_far = effect;
      one = FoundFault{tried[r][t], r, as_good(tried[r], effects[r], t, criteria)};
    }
  }
  if (!found && unlike && becomes_like_others(inputs, fit, *unlike)) return unlike;
  return found;
}

/// Whether calibration went as far as it may, beyond what the model file believes: not for values of nothing at all.
SUREFOOT_ONCE bool ends_at_a_bound(const LogFit& fit) {
  constexpr double near = 0.01;  // of a range
  for (std::size_t i = 0; i < fit.bound.info.parameters.size(); ++i) {
    const ParameterInfo& one = fit.bound.info.parameters[i];
    const double value = fit.hypothesis.parameters[static_cast<Eigen::Index>(i)], reach = near * (one.high - one.low);
    if (one.fixed || !(reach > 0)) continue;
    if (value > one.high - reach || (value < one.low + reach && one.low != 0)) return true;
  }
  return false;
}

/// How much less the error of all recordings together is, as a logarithm; 0 unless it halves, and is less in most. Half
/// the mean square will do where that takes parameters off the bounds of what the model file believes.
SUREFOOT_ONCE double common_gain(const LogFit& before, const LogFit& after, const Repairs& repairs,
                                 const LogDoctorCriteria& criteria) {
  constexpr double least = 1e-12, whole = 1;  // of an output's variance: as good as no error; nothing is explained
  const auto error_of = [&](const LogFit& fit, std::size_t r) {
    const double error = mean_square(touched(fit.residuals[r], repairs), fit.size);
    return ran_away(error, criteria) ? whole : std::max(error, least);  // its steps may be to blame, not the log
  };
  double better = 0, sum_before = 0, sum_after = 0;
  for (std::size_t r = 0; r < before.error.size(); ++r) {
    const double error = error_of(before, r), now = error_of(after, r);
    better += now < error ? 1 : 0;
    sum_before += error;
    sum_after += now;
  }
  const double gain = std::log(sum_before / sum_after), count = static_cast<double>(before.error.size());
  const double by_chance = 0.5 * (count + criteria.deviations * std::sqrt(count));  // of recordings, by a fair coin
  const bool in_most = better >= std::min(criteria.most_of * count, by_chance);
  const bool believable = ends_at_a_bound(before) && !ends_at_a_bound(after);
  return in_most && gain > std::log(believable ? criteria.suspect_gain : criteria.decisive) ? gain : 0;
}

SUREFOOT_ONCE double worst_output_error(const LogFit& fit) {
  double worst = 0;
  for (Eigen::Index k = 0; k < fit.size.size(); ++k) {
    const double share = fit.typical[k] / fit.size[k];
    worst = std::max(worst, share * share);
  }
  return worst;
}

/// Whether these were faults of all recordings to an examination before.
SUREFOOT_ONCE bool were_named(const LogDoctorInputs& inputs, const SimulatorInfo& info, const Repairs& repairs) {
  return holds_for_all(repairs, [&](const LogRepair& repair) {
    return holds_for_any(inputs.named, [&](const LogFault& fault) {
      const bool of_time = repair.kind == LogFaultKind::time_unit;
      return fault.recording.empty() && fault.kind == name_of(repair.kind) &&
             (of_time || fault.channel == name_of(info, repair.channel));
    });
  });
}

/// Repairs of all recordings that are worth a calibration each: every one where the model makes little of the log, else
/// those of faults that were named before.
SUREFOOT_ONCE std::vector<Repairs> common_repairs(const LogDoctorInputs& inputs, const LogFit& fit) {
  std::vector<Repairs> tried = repairs_to_try(fit.bound.info);
  if (fit.bound.info.kind == SimulatorKind::ode) {
    for (const double unit : time_units) tried.push_back({{.kind = LogFaultKind::time_unit, .amount = unit}});
  }
  const bool in_doubt = worst_output_error(fit) > inputs.criteria.in_doubt || ends_at_a_bound(fit);
  if (!in_doubt) drop_items(tried, [&](const Repairs& one) { return !were_named(inputs, fit.bound.info, one); });
  return tried;
}

SUREFOOT_ONCE std::optional<FoundFault> find_fault_of_all(const LogDoctorInputs& inputs, const LogFit& fit) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  const std::vector<Repairs> tried = common_repairs(inputs, fit);
  std::vector<double> gains;
  for (const Repairs& repairs : tried) {
    std::vector<Recording> recordings;
    for (const Recording& recording : fit.bound.recordings) {
      recordings.push_back(repaired(fit.bound, recording, repairs));
    }
    gains.push_back(common_gain(fit, fit_log(inputs, std::move(recordings)), repairs, criteria));
  }
  const auto best = std::max_element(gains.begin(), gains.end());
  if (best == gains.end() || !(*best > 0)) return std::nullopt;
  FoundFault found{tried[static_cast<std::size_t>(best - gains.begin())]};
  for (std::size_t t = 0; t < tried.size(); ++t) {
    if (gains.begin() + static_cast<std::ptrdiff_t>(t) == best) continue;
    if (gains[t] > *best - std::log(criteria.decisive) / 2) found.also.push_back(tried[t]);
  }
  return found;
}

}  // namespace surefoot::diagnosis
