// Fits of a motion model for nothing but its predictions of final poses: what cross-validation repeats some thousand
// times.
#pragma once

#include <cstdint>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/fit/published_fit.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

enum class FitMethod : std::uint8_t {
  likelihood,  // weighs each measured pose by what the noise makes of it; gives standard errors
  published,   // CMA-ES on the errors of final poses
};

struct PredictorOptions {
  FitMethod method = FitMethod::likelihood;
  CalibrationOptions calibration = {};
  PublishedFitOptions published = {};
};

/// Fits to these sequences, from `start` on; `noise` sets the weights of the likelihood.
AnyMotionModel fit_predictor(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                             const MotionNoise& noise, const PredictorOptions& options, std::uint64_t seed);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/predictor.ipp"
#endif
