// Which noise model a walk needs, by the likelihood of sequences that were not used to fit it (cross-validation).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/motion/fit/noise_fit.hpp"

namespace surefoot {

/// One kind of noise, judged.
struct NoiseCandidate {
  NoiseShape shape = NoiseShape::gaussian;
  NoiseGrowth growth = NoiseGrowth::constant;
  MotionNoise noise;   // fitted to all sequences
  double heldout = 0;  // log likelihood of sequences left out [nats per sequence]
  double behind = 0;   // by how much it is behind the best, and the standard error of that [nats per sequence]
  double behind_error = 0;
};

struct NoiseChoice {
  std::vector<NoiseCandidate> candidates;
  std::size_t chosen = 0;    // the simplest that is not clearly behind the best
  bool shape_known = false;  // single cycles were seen; else uniform and normal noise look the same

  const MotionNoise& noise() const { return candidates[chosen].noise; }
};

struct NoiseChoiceOptions {
  NoiseFitOptions fit = {};
  std::size_t folds = 5;
  double clearly = 2;     // a simpler kind is preferred unless it is behind by this many standard errors ...
  double matters = 0.01;  // ... and by this [nats per cycle]
};

namespace detail {

struct Fold {
  std::vector<WalkSequence> fit, judge;
};

/// Every `folds`-th sequence, from `fold` on, is judged.
inline Fold fold_of(std::span<const WalkSequence> sequences, std::size_t fold, std::size_t folds) {
  Fold result;
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    (i % folds == fold ? result.judge : result.fit).push_back(sequences[i]);
  }
  return result;
}

/// Fits one kind of noise to some sequences and gives the log likelihood of each of others.
template <MotionModel M>
class NoiseJudge {
 public:
  NoiseJudge(const M& model, bool single_cycles, const NoiseFitOptions& options)
      : model_(model), single_cycles_(single_cycles), options_(options) {}

  MotionNoise fit(std::span<const WalkSequence> sequences, NoiseShape shape, NoiseGrowth growth) const {
    if (!single_cycles_) return fit_pose_noise(model_, sequences, growth, options_);
    return fit_cycle_noise(cycle_deviations(model_, sequences), shape, growth, options_, M::parameter_count);
  }

  double judge(const MotionNoise& noise, const WalkSequence& sequence) const {
    const std::span<const WalkSequence> one(&sequence, 1);
    if (!single_cycles_) return log_likelihood(model_, noise, options_.accuracy, one);
    return cycle_log_densities(noise, cycle_deviations(model_, one), options_.accuracy, M::parameter_count).sum();
  }

 private:
  const M& model_;
  bool single_cycles_;
  const NoiseFitOptions& options_;
};

/// The simplest candidate that is not clearly behind the best: one term per component before three, and among equals
/// the likelier. `matters` in nats per sequence.
inline std::size_t simplest_good(const std::vector<NoiseCandidate>& candidates, double clearly, double matters) {
  std::size_t best = candidates.size();
  const auto terms = [&](std::size_t i) { return count_free_terms(candidates[i].growth); };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double behind = candidates[i].behind;
    if (behind > clearly * candidates[i].behind_error && behind > matters) continue;
    if (best == candidates.size() || terms(i) < terms(best) ||
        (terms(i) == terms(best) && candidates[i].heldout > candidates[best].heldout)) {
      best = i;
    }
  }
  return best;
}

}  // namespace detail

/// Tries every growth, and every shape where it can be seen. The motion model stays as it is. Throws MotionError if
/// there are fewer than two sequences.
template <MotionModel M, Executor E>
NoiseChoice choose_noise(const M& model, std::span<const WalkSequence> sequences, const NoiseChoiceOptions& options,
                         const E& executor) {
  check(sequences);
  if (sequences.size() < 2) throw MotionError("choose_noise: at least two sequences are needed to leave one out");
  NoiseChoice choice;
  choice.shape_known = sees_single_cycles(sequences);
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    if (shape == NoiseShape::uniform && !choice.shape_known) continue;
    for (const NoiseGrowth growth :
         {NoiseGrowth::constant, NoiseGrowth::with_speed, NoiseGrowth::with_speed_and_acceleration}) {
      choice.candidates.push_back({.shape = shape, .growth = growth, .noise = {}});
    }
  }
  const std::size_t folds = std::min(options.folds, sequences.size());
  const detail::NoiseJudge<M> judge(model, choice.shape_known, options.fit);
  const std::size_t kinds = choice.candidates.size();
  // Job k: candidate k % kinds on fold k / kinds, or on everything.
  const auto results = map(executor, kinds * (folds + 1), [&](std::size_t job) {
    const NoiseCandidate& candidate = choice.candidates[job % kinds];
    const std::size_t fold = job / kinds;
    std::pair<MotionNoise, std::vector<double>> result;
    if (fold == folds) {
      result.first = judge.fit(sequences, candidate.shape, candidate.growth);
      return result;
    }
    const detail::Fold split = detail::fold_of(sequences, fold, folds);
    result.first = judge.fit(split.fit, candidate.shape, candidate.growth);
    for (const WalkSequence& sequence : split.judge) result.second.push_back(judge.judge(result.first, sequence));
    return result;
  });
  // By candidate and sequence.
  std::vector<Eigen::ArrayXd> heldout(kinds, Eigen::ArrayXd(static_cast<Eigen::Index>(sequences.size())));
  for (std::size_t k = 0; k < kinds; ++k) {
    Eigen::Index next = 0;
    for (std::size_t fold = 0; fold < folds; ++fold) {
      for (const double value : results[fold * kinds + k].second) heldout[k][next++] = value;
    }
    choice.candidates[k].noise = results[folds * kinds + k].first;
    choice.candidates[k].heldout = heldout[k].mean();
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < kinds; ++k) {
    if (choice.candidates[k].heldout > choice.candidates[best].heldout) best = k;
  }
  const auto count = static_cast<double>(sequences.size());
  for (std::size_t k = 0; k < kinds; ++k) {
    const Eigen::ArrayXd behind = heldout[best] - heldout[k];
    NoiseCandidate& candidate = choice.candidates[k];
    candidate.behind = behind.mean();
    candidate.behind_error = std::sqrt((behind - behind.mean()).square().sum() / (count - 1) / count);
  }
  double cycles = 0;
  for (const WalkSequence& sequence : sequences) cycles += static_cast<double>(sequence.cycles());
  choice.chosen = detail::simplest_good(choice.candidates, options.clearly, options.matters * cycles / count);
  return choice;
}

}  // namespace surefoot
