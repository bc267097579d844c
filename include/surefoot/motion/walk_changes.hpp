// Comparison of a walk with what it was before: which coefficients of its motion model changed, whether its response
// comes later, its noise grew or it falls more often. One criterion decides: a statement is made if its posterior
// probability is at least `certainty` (changes/sparse_changes.hpp); where the data cannot tell changes apart the
// statement is that one of several happened. If nothing changed an alarm is raised in less than
// (1 - certainty) / certainty of all comparisons, by Markov's inequality, as long as the evidence is worked out right.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/changes/noise_change.hpp"
#include "surefoot/motion/changes/sparse_changes.hpp"
#include "surefoot/motion/changes/walk_noise.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

struct WalkChangeOptions {
  PoseAccuracy accuracy = {};     // of the measured poses
  Vec<3> noise_scale{0.08, 0.04, 0.4};  // commands that count as speed 1 in the noise [m, m, rad]
  double prior = 0.25;            // coefficients lie about their defaults by this [widths of their ranges]
  double jump_deviation = 0.1;    // standard deviation of a change of a coefficient [width of its range]
  double delay_deviation = 0.3;   // of a response that comes later by a part of a cycle [cycles]
  double noise_deviation = 1;     // of the logarithm of a change of the variance: a factor of 1.6 of the noise
  int largest_delay = 3;          // [cycles] that commands may come later by
  double certainty = 0.95;        // posterior probability from which on a statement is made
  SparseChangeOptions sets = {};
};

/// Throws MotionError, naming the field.
void check(const WalkChangeOptions& options);

/// A walk as it was: a calibration, and the sequences that it was made from where they are still known.
struct FormerWalk {
  AnyMotionModel model;
  Eigen::MatrixXd covariance = {};  // of its parameters; not used if sequences are given
  MotionNoise noise = {};           // not used if sequences are given
  std::size_t sequences = 0;        // how many it was calibrated from
  std::size_t readings = 0;         // coordinates measured in them
  std::span<const WalkSequence> recorded = {};
};

/// How one coefficient changed.
struct CoefficientComparison {
  ModelParameter info;
  double before = 0, after = 0;
  double difference = 0, standard_error = 0;  // whatever else changed
  double probability = 0;                     // that it changed
  double smallest = 0;                        // change that would be found, alone, in 95 of 100 comparisons
};

/// The statement that at least one of these changes happened.
struct FoundChange {
  std::vector<int> any_of = {};  // indices of WalkComparison::changes, the likeliest first; -1: a delay of whole cycles
  double probability = 0;
};

struct WalkComparison {
  AnyMotionModel before, after;  // the coefficients of the new walk, all of them free
  std::vector<CoefficientComparison> coefficients = {};
  std::vector<WalkChange> changes = {};     // all that could happen
  ChangePosterior posterior = {};
  std::vector<FoundChange> found = {};      // empty: nothing changed, as far as can be seen
  ChangeSet likeliest = {};                 // the likeliest set that agrees with what was found
  ChangeSizes sizes = {};                   // of its changes
  std::vector<NoiseChange> noise = {};
  std::optional<FallChange> falls = {};     // if any sequence fell
  int former_delay = 0;                // [cycles] the old walk responded later than its commands
  double inflation = 1;                // how much more whole sequences differ than independent cycles would [variance]
  Eigen::VectorXd alone = {};          // by change: its size, if it is added to the likeliest set

  /// Size of a change of coefficients: as in the likeliest set, or added to it.
  double size_of(int change) const { return alone[change]; }
};

/// How often the sequences fell; none if that is not known.
struct WalkFalls {
  FallCount before, after;
};

/// The model of `before` is that of both. Cost: about twenty fits. Throws MotionError if a sequence cannot be used.
WalkComparison compare_walks(const FormerWalk& before, std::span<const WalkSequence> after,
                             const WalkChangeOptions& options = {}, const std::optional<WalkFalls>& falls = {});

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/walk_changes.ipp"
#endif
