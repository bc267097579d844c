// A motion model fitted for nothing but its predictions of final poses: what cross-validation repeats some thousand
// times.
#pragma once

#include <cstdint>
#include <span>

#include "surefoot/core/executor.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/fit/published_fit.hpp"

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

/// Fits to these sequences; `noise` sets the weights of the likelihood.
template <MotionModel M>
M fit_predictor(std::span<const WalkSequence> sequences, const MotionNoise& noise, const PredictorOptions& options,
                std::uint64_t seed) {
  if (options.method == FitMethod::published) {
    return published_fit<M>(sequences, options.published, Serial{}, seed).model;
  }
  return fit_model<M>(sequences, noise, options.calibration.model).model;
}

}  // namespace surefoot
