// The noise of two walks, compared: cycle by cycle and component by component where single cycles were measured, else by
// how far sequences end from where they should.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/changes/noise_change.hpp"
#include "surefoot/motion/changes/sequence_fit.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// The noise of one component of the displacement of a cycle, or of all.
struct NoiseChange {
  std::string name;              // "noise forward", ...; "noise" of all
  double before = 0, after = 0;  // standard deviation in a cycle with the new commands [m or rad]; of all: 1 and ratio
  VarianceChange change = {};
};

}  // namespace surefoot

namespace surefoot::detail {

/// Noise that grows with speed and acceleration as far as single cycles tell, else `constant`.
MotionNoise noise_with_growth(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                              const MotionNoise& constant, const PoseAccuracy& accuracy);

/// A walk with the fit of its coefficients; without sequences it is what it was calibrated as, from so many readings.
struct WalkWithFit {
  const SequenceFit& fit;
  std::span<const WalkSequence> sequences;
  std::size_t readings;
};

struct NoiseOfWalks {
  std::vector<NoiseChange> components = {};
  MotionNoise after;  // the old noise, scaled to that of the new walk as far as that shows it
};

NoiseOfWalks compare_noise(const WalkWithFit& before, const WalkWithFit& after, const MotionNoise& noise,
                           const PoseAccuracy& accuracy, double deviation);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/changes/walk_noise.ipp"
#endif
