// Definitions of surefoot/motion/fit/choose_noise.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/fit/choose_noise.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const NoiseChoiceOptions& options) {
  check(options.fit);
  if (options.folds < 2) {
    throw MotionError("NoiseChoiceOptions: folds must be at least 2, got " + std::to_string(options.folds));
  }
  if (!(options.tolerance >= 0 && options.negligible_loss >= 0)) {
    throw MotionError("NoiseChoiceOptions: tolerance and negligible_loss must not be negative");
  }
}

namespace detail {

SUREFOOT_INLINE NoiseComparison::NoiseComparison(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                                                 const NoiseChoiceOptions& options)
    : model_(model), sequences_(sequences), options_(options), folds_(std::min(options.folds, sequences.size())) {
  check(options);
  check(sequences);
  if (sequences.size() < 2) throw MotionError("choose_noise: at least two sequences are needed to leave one out");
  choice_.shape_known = sees_single_cycles(sequences);
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    if (shape == NoiseShape::uniform && !choice_.shape_known) continue;
    for (const NoiseGrowth growth :
         {NoiseGrowth::constant, NoiseGrowth::with_speed, NoiseGrowth::with_speed_and_acceleration}) {
      choice_.candidates.push_back({.shape = shape, .growth = growth, .noise = {}});
    }
  }
}

SUREFOOT_INLINE MotionNoise NoiseComparison::fit(std::span<const WalkSequence> sequences,
                                                 const NoiseCandidate& kind) const {
  if (!choice_.shape_known) return fit_pose_noise(model_, sequences, kind.growth, options_.fit);
  return fit_cycle_noise(cycle_deviations(model_, sequences), kind.shape, kind.growth, options_.fit,
                         static_cast<int>(model_.parameter_count()));
}

SUREFOOT_INLINE double NoiseComparison::evaluate(const MotionNoise& noise, const WalkSequence& sequence) const {
  const std::span<const WalkSequence> one(&sequence, 1);
  const PoseAccuracy& accuracy = options_.fit.accuracy;
  if (!choice_.shape_known) return log_likelihood(model_, noise, accuracy, one);
  return cycle_log_densities(noise, cycle_deviations(model_, one), accuracy, static_cast<int>(model_.parameter_count()))
      .sum();
}

SUREFOOT_INLINE NoiseComparison::Result NoiseComparison::run(std::size_t job) const {
  const std::size_t kinds = choice_.candidates.size(), fold = job / kinds;
  const NoiseCandidate& candidate = choice_.candidates[job % kinds];
  if (fold == folds_) return {fit(sequences_, candidate), {}};
  std::vector<WalkSequence> fitted, held_out;  // every folds-th sequence, from `fold` on, is held out
  for (std::size_t i = 0; i < sequences_.size(); ++i) (i % folds_ == fold ? held_out : fitted).push_back(sequences_[i]);
  Result result{fit(fitted, candidate), {}};
  for (const WalkSequence& sequence : held_out) result.second.push_back(evaluate(result.first, sequence));
  return result;
}

SUREFOOT_INLINE NoiseChoice NoiseComparison::choose(const std::vector<Result>& results) const {
  NoiseChoice choice = choice_;
  const std::size_t kinds = choice.candidates.size();
  // By candidate and sequence.
  std::vector<Eigen::ArrayXd> heldout(kinds, Eigen::ArrayXd(static_cast<Eigen::Index>(sequences_.size())));
  for (std::size_t k = 0; k < kinds; ++k) {
    Eigen::Index next = 0;
    for (std::size_t fold = 0; fold < folds_; ++fold) {
      for (const double value : results[fold * kinds + k].second) heldout[k][next++] = value;
    }
    choice.candidates[k].noise = results[folds_ * kinds + k].first;
    choice.candidates[k].heldout = heldout[k].mean();
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < kinds; ++k) {
    if (choice.candidates[k].heldout > choice.candidates[best].heldout) best = k;
  }
  const auto count = static_cast<double>(sequences_.size());
  for (std::size_t k = 0; k < kinds; ++k) {
    Eigen::ArrayXd behind = heldout[best];
    behind -= heldout[k];
    NoiseCandidate& candidate = choice.candidates[k];
    candidate.behind = behind.mean();
    for (double& one : behind) one -= candidate.behind;
    const double squares = dot(behind.data(), behind.data(), behind.size());
    candidate.behind_error = std::sqrt(squares / (count - 1) / count);
  }
  double cycles = 0;
  for (const WalkSequence& sequence : sequences_) cycles += static_cast<double>(sequence.cycles());
  choice.chosen = simplest_good(choice.candidates, options_.tolerance, options_.negligible_loss * cycles / count);
  return choice;
}

SUREFOOT_INLINE std::size_t simplest_good(const std::vector<NoiseCandidate>& candidates, double tolerance,
                                          double negligible_loss) {
  std::size_t best = candidates.size();
  const auto terms = [&](std::size_t i) { return count_free_terms(candidates[i].growth); };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double behind = candidates[i].behind;
    if (behind > tolerance * candidates[i].behind_error && behind > negligible_loss) continue;
    if (best == candidates.size() || terms(i) < terms(best) ||
        (terms(i) == terms(best) && candidates[i].heldout > candidates[best].heldout)) {
      best = i;
    }
  }
  return best;
}

}  // namespace detail

}  // namespace surefoot
