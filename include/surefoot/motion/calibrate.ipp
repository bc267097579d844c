// Definitions of surefoot/motion/calibrate.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/fit/noise_fit.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const CalibrationOptions& options) {
  check(options.model);
  const auto positive = [](const Vec<3>& v, const char* field) {
    if (!(v.minCoeff() > 0 && all_finite(v))) {
      throw MotionError(std::string("CalibrationOptions: ") + field + " must be finite and above 0 in every component");
    }
  };
  positive(options.noise_scale, "noise_scale");
  positive(options.first_noise, "first_noise");
  if (options.rounds < 0) {
    throw MotionError("CalibrationOptions: rounds must not be negative, got " + std::to_string(options.rounds));
  }
}

namespace detail {

/// How many coordinates were measured; a heading without a position does not count.
SUREFOOT_INLINE Eigen::Index count_measured(std::span<const WalkSequence> sequences) {
  Eigen::Index values = 0;
  for (const WalkSequence& sequence : sequences) {
    for (Eigen::Index i = 0; i < sequence.cycles(); ++i) {
      values += !sequence.position_measured(i) ? 0 : sequence.heading_measured(i) ? 3 : 2;
    }
  }
  return values;
}

}  // namespace detail

SUREFOOT_INLINE AnyCalibration calibrate(std::span<const WalkSequence> sequences, const CalibrationOptions& options,
                                         const AnyMotionModel& start) {
  constexpr double least_left = 0.1;  // share of the variance that the parameters leave at least, with few readings
  check(options);
  check(sequences);
  const bool single_cycles = sees_single_cycles(sequences);
  const NoiseFitOptions noise_options{.accuracy = options.model.accuracy, .scale = options.noise_scale};
  const auto count = static_cast<int>(start.parameter_count());
  AnyCalibration result{.model = start};
  result.noise.scale = options.noise_scale;
  result.noise.constant = options.first_noise;
  const auto fit = [&] {
    AnyModelFit fitted = fit_model(sequences, result.noise, options.model, result.model);
    result.model = std::move(fitted.model);
    result.covariance = std::move(fitted.covariance);
  };
  // What the parameters took away from the deviations.
  const double spent = static_cast<double>(count) / static_cast<double>(detail::count_measured(sequences));
  for (int round = 0; round < options.rounds; ++round) {
    fit();
    if (single_cycles) {
      result.noise = fit_cycle_noise(cycle_deviations(result.model, sequences), NoiseShape::gaussian,
                                     NoiseGrowth::constant, noise_options, count);
    } else {
      result.noise =
          fit_pose_noise(result.model, sequences, NoiseGrowth::constant, noise_options, result.noise.constant);
    }
    result.noise.constant /= std::sqrt(std::max(least_left, 1 - spent));
  }
  fit();
  result.log_likelihood = log_likelihood(result.model, result.noise, options.model.accuracy, sequences);
  return result;
}

}  // namespace surefoot
