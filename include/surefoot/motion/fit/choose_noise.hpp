// Choice of the noise model that a walk needs, by the likelihood of held-out sequences (cross-validation).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/fit/noise_fit.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// One kind of noise and what it is worth.
struct NoiseCandidate {
  NoiseShape shape = NoiseShape::gaussian;
  NoiseGrowth growth = NoiseGrowth::constant;
  MotionNoise noise;   // fitted to all sequences
  double heldout = 0;  // log likelihood of held-out sequences [nats per sequence]
  double behind = 0;   // by how much it is behind the best, and the standard error of that [nats per sequence]
  double behind_error = 0;
};

struct NoiseChoice {
  std::vector<NoiseCandidate> candidates;
  std::size_t chosen = 0;    // the simplest that is not behind the best by more than the tolerance
  bool shape_known = false;  // single cycles were seen; else uniform and normal noise look the same

  const MotionNoise& noise() const { return candidates[chosen].noise; }
};

struct NoiseChoiceOptions {
  NoiseFitOptions fit = {};
  std::size_t folds = 5;
  double tolerance = 2;           // a simpler kind is preferred unless it is behind by this many standard errors ...
  double negligible_loss = 0.01;  // ... and by this [nats per cycle]
};

/// Throws MotionError, naming the field.
void check(const NoiseChoiceOptions& options);

namespace detail {

/// All fits of all kinds of noise, as independent jobs.
class NoiseComparison {
 public:
  /// A fitted noise, and the log likelihood of each sequence that it was not fitted to [nats].
  using Result = std::pair<MotionNoise, std::vector<double>>;

  NoiseComparison(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                  const NoiseChoiceOptions& options);

  std::size_t jobs() const { return choice_.candidates.size() * (folds_ + 1); }

  /// Job k: candidate k % kinds on fold k / kinds, or on everything.
  Result run(std::size_t job) const;

  NoiseChoice choose(const std::vector<Result>& results) const;

 private:
  MotionNoise fit(std::span<const WalkSequence> sequences, const NoiseCandidate& kind) const;
  double evaluate(const MotionNoise& noise, const WalkSequence& sequence) const;

  AnyMotionModel model_;
  std::span<const WalkSequence> sequences_;
  NoiseChoiceOptions options_;
  std::size_t folds_;
  NoiseChoice choice_;  // its candidates are not fitted yet
};

/// The simplest candidate that is not behind the best by more than both tolerance [standard errors] and
/// negligible_loss [nats per sequence]: one term per component before three, and among equals the likelier.
std::size_t simplest_good(const std::vector<NoiseCandidate>& candidates, double tolerance, double negligible_loss);

}  // namespace detail

/// Tries every growth, and every shape where it can be seen. The motion model stays as it is. Throws MotionError if
/// there are fewer than two sequences.
template <Executor E>
NoiseChoice choose_noise(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                         const NoiseChoiceOptions& options, const E& executor) {
  const detail::NoiseComparison comparison(model, sequences, options);
  return comparison.choose(map(executor, comparison.jobs(), [&](std::size_t job) { return comparison.run(job); }));
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/choose_noise.ipp"
#endif
