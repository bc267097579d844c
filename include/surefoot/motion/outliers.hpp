// Outliers: sequences whose final pose is nowhere near the model; wrong readings, most likely.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// A sequence that ends far from where a model puts it.
struct SequenceOutlier {
  std::size_t sequence = 0;  // its index
  double distance = 0;       // of the measured final position from the predicted one [m]
  double typical = 0;        // median of all those distances [m]
  double turned = 0;         // measured minus predicted heading [rad]; 0 if it was not measured
};

/// All sequences that would be that far off once in a million. A fit that wrong readings do not decide (Huber's loss)
/// and the median of all errors are the measure, since a wrong reading makes all else look noisy. `start` names the
/// model. Throws MotionError if a sequence cannot be used.
std::vector<SequenceOutlier> find_outliers(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                                           const CalibrationOptions& options);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/outliers.ipp"
#endif
