// Definitions of surefoot/motion/walk_changes.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/changes/delayed_commands.hpp"
#include "surefoot/motion/changes/possible_changes.hpp"
#include "surefoot/motion/changes/sequence_fit.hpp"
#include "surefoot/motion/changes/walk_noise.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/walk_changes.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const WalkChangeOptions& options) {
  check(options.accuracy);
  check(options.sets);
  const std::array<std::pair<double, const char*>, 5> positive{{{options.prior, "prior"},
                                                                {options.jump_deviation, "jump_deviation"},
                                                                {options.delay_deviation, "delay_deviation"},
                                                                {options.noise_deviation, "noise_deviation"},
                                                                {options.noise_scale.minCoeff(), "noise_scale"}}};
  for (const auto& [value, field] : positive) {
    if (!(value > 0 && std::isfinite(value))) {
      throw MotionError(std::string("WalkChangeOptions: ") + field + " must be finite and above 0");
    }
  }
  if (options.largest_delay < 0) throw MotionError("WalkChangeOptions: largest_delay must not be negative");
  if (!(options.certainty > 0.5 && options.certainty < 1)) {
    throw MotionError("WalkChangeOptions: certainty must be between 0.5 and 1");
  }
}

namespace detail {

/// The old walk, fitted.
struct FittedFormerWalk {
  SequenceFit fit;
  MotionNoise noise;
  int delay = 0;  // [cycles]
};

SUREFOOT_INLINE double half_log_determinant(const Eigen::MatrixXd& covariance) {
  return Cholesky(covariance).half_log_determinant();
}

/// Of all innovations, whatever the size of the noise: how likely the best fit makes them [nats].
SUREFOOT_INLINE double log_best_likelihood(const SequenceFit& fit, double inflation) {
  return -0.5 * fit.counts.sum() / inflation * std::log(fit.squares.sum());
}

/// How much more whole sequences differ, on average over the coefficients; at least 1.
SUREFOOT_INLINE double mean_inflation(const Eigen::MatrixXd& inflation) {
  return std::max(1.0, inflation.trace() / static_cast<double>(inflation.rows()));
}

/// The index of the one that leaves least.
SUREFOOT_INLINE std::size_t best_fit(const std::vector<SequenceFit>& fits) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < fits.size(); ++i) {
    if (fits[i].squares.sum() < fits[best].squares.sum()) best = i;
  }
  return best;
}

/// The delay of commands that the old walk was recorded with: none, unless another one is far more likely.
SUREFOOT_INLINE int former_delay(std::span<const WalkSequence> recorded, const AnyMotionModel& start,
                                 const MotionNoise& noise, const WalkChangeOptions& options) {
  if (!commands_vary(recorded)) return 0;
  const ParameterPrior prior{start.default_parameters(), prior_information(start, options.prior)};
  std::vector<SequenceFit> fits;
  for (int delay = 0; delay <= options.largest_delay; ++delay) {
    fits.push_back(
        fit_sequences(delayed(recorded, delay, options.largest_delay + 1), start, noise, options.accuracy, prior));
  }
  const std::size_t best = best_fit(fits);
  const SequenceFit* const likeliest[] = {&fits[best]};
  const double inflation = mean_inflation(covariance_inflation(likeliest));
  const double more = log_best_likelihood(fits[best], inflation) - log_best_likelihood(fits[0], inflation);
  return more > std::log(options.certainty / (1 - options.certainty)) ? static_cast<int>(best) : 0;
}

SUREFOOT_INLINE FittedFormerWalk fit_former(const FormerWalk& before, const WalkChangeOptions& options) {
  const AnyMotionModel& start = before.model;
  if (before.recorded.empty()) {
    FittedFormerWalk result{.fit = {.model = start}, .noise = before.noise};
    const Eigen::VectorXd width = start.parameter_box().width();
    result.fit.root = map_eigenvalues(scaled(Eigen::VectorXd(width.cwiseInverse()), before.covariance),
                                      [](double value) { return std::sqrt(std::max(value, 0.0)); });
    result.fit.prior_share = Eigen::MatrixXd::Zero(width.size(), width.size());
    return result;
  }
  CalibrationOptions calibration;
  calibration.model.accuracy = options.accuracy;
  calibration.model.prior = options.prior;
  calibration.noise_scale = options.noise_scale;
  calibration.first_noise = options.noise_scale / 8;  // as the program's fit
  const AnyCalibration first = calibrate(before.recorded, calibration, start);
  const int delay = former_delay(before.recorded, first.model, first.noise, options);
  const std::vector<WalkSequence> recorded = delayed(before.recorded, delay);
  const AnyCalibration found = delay == 0 ? first : calibrate(recorded, calibration, start);
  const MotionNoise noise = noise_with_growth(found.model, recorded, found.noise, options.accuracy);
  const ParameterPrior prior{start.default_parameters(), prior_information(start, options.prior)};
  return {.fit = fit_sequences(recorded, found.model, noise, options.accuracy, prior), .noise = noise, .delay = delay};
}

/// The new walk for each delay, fitted with one noise.
SUREFOOT_INLINE std::vector<SequenceFit> fit_by_delay(const std::vector<std::vector<WalkSequence>>& by_delay,
                                                      const AnyMotionModel& former, const MotionNoise& noise,
                                                      const WalkChangeOptions& options) {
  const ParameterPrior prior{former.parameters(), prior_information(former, options.prior)};
  std::vector<SequenceFit> fits;
  for (const std::vector<WalkSequence>& sequences : by_delay) {
    fits.push_back(fit_sequences(sequences, former, noise, options.accuracy, prior));
  }
  return fits;
}

/// The evidence about the coefficients for one delay; `common` is the fit to the cycles that are seen at all delays.
SUREFOOT_INLINE DifferenceEvidence difference_evidence(const SequenceFit& before, const SequenceFit& after,
                                                       const SequenceFit& common, int delay,
                                                       const Eigen::MatrixXd& inflation, double freedoms) {
  DifferenceEvidence result{.delay = delay, .freedoms = freedoms};
  result.difference = after.model.parameters() - before.model.parameters();
  const Eigen::MatrixXd own = after.covariance(inflation), covariance = before.covariance(inflation) + own;
  const Cholesky root(covariance);
  if (!root.ok()) throw MotionError("the covariance of the coefficients is not positive definite");
  result.information = root.inverse();
  const double squared = squared_norm(root.solve_lower(result.difference));
  const double half = 0.5 * (freedoms + static_cast<double>(result.difference.size()));
  result.log_evidence = log_best_likelihood(common, mean_inflation(inflation)) + half_log_determinant(own) -
                        root.half_log_determinant() - half * std::log1p(squared / freedoms);
  return result;
}

/// The statements that are certain enough: first of single changes, then that one of several happened.
SUREFOOT_INLINE std::vector<FoundChange> certain_changes(const ChangePosterior& posterior, double certainty) {
  std::vector<std::pair<double, int>> open;
  for (int i = -1; i < posterior.inclusion.size(); ++i) open.emplace_back(posterior.any_of(std::array{i}), i);
  std::ranges::stable_sort(open, std::ranges::greater{}, &std::pair<double, int>::first);
  std::vector<FoundChange> found;
  while (!open.empty()) {
    FoundChange next;
    for (const auto& [probability, change] : open) {
      next.any_of.push_back(change);
      next.probability = posterior.any_of(next.any_of);
      if (next.probability >= certainty) break;
    }
    if (next.probability < certainty) break;
    std::erase_if(open, [&](const auto& one) { return std::ranges::count(next.any_of, one.second) > 0; });
    found.push_back(std::move(next));
  }
  return found;
}

SUREFOOT_INLINE ChangeSet likeliest_set(const ChangePosterior& posterior, const std::vector<FoundChange>& found) {
  for (const ChangeSet& set : posterior.sets) {
    const bool agrees = std::ranges::all_of(found, [&](const FoundChange& one) {
      return std::ranges::any_of(one.any_of, [&](int change) {
        return change < 0 ? set.delay != 0 : std::ranges::binary_search(set.members, change);
      });
    });
    if (agrees) return set;
  }
  return posterior.sets.front();
}

/// That it changed by itself, or with that of the other side or of the next cycle; a response that comes later moves
/// all coefficients, and is a statement of its own.
SUREFOOT_INLINE double probability_of_coefficient(const ChangePosterior& posterior, std::span<const WalkChange> changes,
                                                  Eigen::Index coefficient) {
  std::vector<int> that_move;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Eigen::VectorXd& direction = changes[i].direction;
    if (direction.size() == 0 || (direction.array() != 0).count() > 2) continue;
    if (direction[coefficient] != 0) that_move.push_back(static_cast<int>(i));
  }
  return posterior.any_of(that_move);
}

SUREFOOT_INLINE void fill_coefficients(const SequenceFit& before, const SequenceFit& after,
                                       const DifferenceEvidence& evidence, const WalkChangeOptions& options,
                                       WalkComparison& result) {
  const Eigen::MatrixXd covariance = Cholesky(evidence.information).inverse();
  Eigen::Index i = 0;
  for (const ModelParameter& info : before.model.parameter_info()) {
    CoefficientComparison one{.info = info};
    one.before = before.model.parameters()[i];
    one.after = after.model.parameters()[i];
    one.difference = one.after - one.before;
    one.standard_error = std::sqrt(covariance(i, i));
    one.probability = probability_of_coefficient(result.posterior, result.changes, i);
    const auto own = std::ranges::find(result.changes, info.name, &WalkChange::name);
    one.smallest = own == result.changes.end()
                       ? INFINITY
                       : smallest_detectable(evidence, result.changes, static_cast<int>(own - result.changes.begin()),
                                             options.certainty, options.sets);
    result.coefficients.push_back(one);
    ++i;
  }
}

/// By change: its size as in the likeliest set, or in place of those members that exclude it.
SUREFOOT_INLINE Eigen::VectorXd sizes_alone(const WalkComparison& result, const DifferenceEvidence& evidence) {
  Eigen::VectorXd sizes(static_cast<Eigen::Index>(result.changes.size()));
  for (int i = 0; i < sizes.size(); ++i) {
    const auto holds = [&](const ChangeSet& set) {
      return set.delay == evidence.delay && std::ranges::binary_search(set.members, i);
    };
    const auto set = std::ranges::find_if(result.posterior.sets, holds);
    if (set == result.posterior.sets.end()) {
      sizes[i] = 0;
      continue;
    }
    const auto place = std::ranges::find(set->members, i) - set->members.begin();
    sizes[i] = change_sizes(evidence, result.changes, set->members).size[place];
  }
  return sizes;
}

/// Half of the prior weight is that of the coefficients, the other half is shared by the kinds delay, noise and falls.
constexpr double other_kinds = 3;

/// Changes that are not of coefficients, in the order: components of the noise, falls.
SUREFOOT_INLINE void add_other_changes(const std::optional<WalkFalls>& falls, WalkComparison& result) {
  const auto coefficients = static_cast<double>(result.changes.size());
  const double weight = coefficients / other_kinds;
  for (const NoiseChange& noise : result.noise) {
    result.changes.push_back({.name = noise.name,
                              .weight = weight / static_cast<double>(result.noise.size()),
                              .log_bayes_factor = noise.change.log_bayes_factor});
  }
  if (falls && falls->before.fell + falls->after.fell > 0) {
    result.falls = fall_change(falls->before, falls->after);
    result.changes.push_back({.name = "falls", .weight = weight, .log_bayes_factor = result.falls->log_bayes_factor});
  }
}

}  // namespace detail

SUREFOOT_INLINE WalkComparison compare_walks(const FormerWalk& before, std::span<const WalkSequence> after,
                                             const WalkChangeOptions& options, const std::optional<WalkFalls>& falls) {
  check(options);
  check(after);
  const detail::FittedFormerWalk former = detail::fit_former(before, options);
  const bool visible =
      detail::commands_vary(after) && (before.recorded.empty() || detail::commands_vary(before.recorded));
  const std::vector<int> delays = detail::possible_delays(former.delay, visible ? options.largest_delay : -1);
  std::vector<std::vector<WalkSequence>> by_delay, common;
  for (const int delay : delays) {
    by_delay.push_back(detail::delayed(after, delay + former.delay));
    common.push_back(detail::delayed(after, delay + former.delay, options.largest_delay + 1));
  }
  const std::size_t best = detail::best_fit(detail::fit_by_delay(common, former.fit.model, former.noise, options));
  std::vector<SequenceFit> fits = detail::fit_by_delay(by_delay, former.fit.model, former.noise, options);
  WalkComparison result{.before = former.fit.model, .after = fits[best].model, .former_delay = former.delay};
  const std::vector<WalkSequence> recorded = detail::delayed(before.recorded, former.delay);
  const detail::NoiseOfWalks noise =
      detail::compare_noise({former.fit, recorded, before.readings}, {fits[best], by_delay[best], 0}, former.noise,
                            options.accuracy, options.noise_deviation);
  result.noise = noise.components;
  fits = detail::fit_by_delay(by_delay, former.fit.model, noise.after, options);
  const std::vector<SequenceFit> alike = detail::fit_by_delay(common, former.fit.model, noise.after, options);
  std::vector<const SequenceFit*> seen{&fits[best]};
  if (!recorded.empty()) seen.push_back(&former.fit);
  const Eigen::MatrixXd inflation = covariance_inflation(seen);
  result.inflation = inflation.trace() / static_cast<double>(inflation.rows());
  const double sequences = static_cast<double>((recorded.empty() ? before.sequences : recorded.size()) + after.size());
  std::vector<DifferenceEvidence> evidence;
  for (std::size_t i = 0; i < delays.size(); ++i) {
    evidence.push_back(
        detail::difference_evidence(former.fit, fits[i], alike[i], delays[i], inflation, std::max(1.0, sequences - 2)));
  }
  result.changes =
      detail::possible_changes(former.fit.model, options.jump_deviation, options.delay_deviation, !recorded.empty());
  SparseChangeOptions sets = options.sets;
  sets.delay_weight = static_cast<double>(result.changes.size()) / detail::other_kinds;
  detail::add_other_changes(falls, result);
  result.posterior = posterior_of_changes(evidence, result.changes, sets);
  result.found = detail::certain_changes(result.posterior, options.certainty);
  result.likeliest = detail::likeliest_set(result.posterior, result.found);
  const auto chosen = static_cast<std::size_t>(std::ranges::find(delays, result.likeliest.delay) - delays.begin());
  result.after = fits[chosen].model;
  result.sizes = change_sizes(evidence[chosen], result.changes, result.likeliest.members);
  result.alone = detail::sizes_alone(result, evidence[chosen]);
  detail::fill_coefficients(former.fit, fits[chosen], evidence[chosen], options, result);
  return result;
}

}  // namespace surefoot
