// From recorded sequences to a motion model, how well it is known, and the noise of the walk. Model and noise are
// fitted in turn, each by maximum likelihood given the other: the noise decides how much each measured pose counts for
// the model, and what the model leaves over is the noise.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/motion/fit/choose_noise.hpp"
#include "surefoot/motion/fit/fit_model.hpp"

namespace surefoot {

struct CalibrationOptions {
  ModelFitOptions model = {};
  Vec<3> noise_scale{0.08, 0.04, 0.4};   // commands that count as speed 1 in the noise [m, m, rad]
  Vec<3> first_noise{0.01, 0.01, 0.05};  // first guess of its deviation per cycle [m, m, rad]
  int rounds = 3;                        // of model and noise in turn
};

template <MotionModel M>
struct Calibration {
  M model;
  typename ModelFit<M>::Covariance covariance;  // of its parameters
  MotionNoise noise;                            // constant, normal: what the weights of the poses are made from
  double log_likelihood = 0;                    // of all measured poses [nats]

  Vec<M::parameter_count> standard_errors() const { return covariance.diagonal().cwiseSqrt(); }
};

/// Fits model and constant noise. Cost: some ten milliseconds for 25 sequences of 25 cycles and 12 parameters.
/// Throws MotionError if a sequence cannot be used.
template <MotionModel M>
Calibration<M> calibrate(std::span<const WalkSequence> sequences, const CalibrationOptions& options = {},
                         const M& start = M()) {
  check(sequences);
  const bool single_cycles = sees_single_cycles(sequences);
  const NoiseFitOptions noise_options{.accuracy = options.model.accuracy, .scale = options.noise_scale};
  Calibration<M> result{.model = start, .covariance = {}, .noise = {}};
  result.noise.scale = options.noise_scale;
  result.noise.constant = options.first_noise;
  for (int round = 0; round < options.rounds; ++round) {
    const ModelFit<M> fit = fit_model(sequences, result.noise, options.model, result.model);
    result.model = fit.model;
    result.covariance = fit.covariance;
    Eigen::Index values = 0;
    for (const WalkSequence& sequence : sequences) {
      for (Eigen::Index i = 0; i < sequence.cycles(); ++i) {
        values += !sequence.position_measured(i) ? 0 : sequence.heading_measured(i) ? 3 : 2;
      }
    }
    if (single_cycles) {
      result.noise = fit_cycle_noise(cycle_deviations(result.model, sequences), NoiseShape::gaussian,
                                     NoiseGrowth::constant, noise_options, M::parameter_count);
    } else {
      result.noise =
          fit_pose_noise(result.model, sequences, NoiseGrowth::constant, noise_options, result.noise.constant);
    }
    // What the parameters took away from the deviations.
    const auto spent = static_cast<double>(M::parameter_count) / static_cast<double>(values);
    result.noise.constant /= std::sqrt(std::max(0.1, 1 - spent));
  }
  const ModelFit<M> fit = fit_model(sequences, result.noise, options.model, result.model);
  result.model = fit.model;
  result.covariance = fit.covariance;
  result.log_likelihood = log_likelihood(result.model, result.noise, options.model.accuracy, sequences);
  return result;
}

}  // namespace surefoot
