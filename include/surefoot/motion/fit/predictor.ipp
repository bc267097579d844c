// Definitions of surefoot/motion/fit/predictor.hpp.
#pragma once

#include <cstdint>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/motion/fit/predictor.hpp"

namespace surefoot {

SUREFOOT_INLINE AnyMotionModel fit_predictor(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                                             const MotionNoise& noise, const PredictorOptions& options,
                                             std::uint64_t seed) {
  if (options.method == FitMethod::published) {
    return published_fit(start, sequences, options.published, Serial{}, seed).model;
  }
  return fit_model(sequences, noise, options.calibration.model, start).model;
}

}  // namespace surefoot
