// Calibration: from recorded sequences to a motion model, how well it is known, and the noise of the walk. Model and
// noise are fitted in turn, each by maximum likelihood given the other: the noise decides how much each measured pose
// counts for the model, and what the model leaves over is the noise.
#pragma once

#include <Eigen/Core>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/fit/choose_noise.hpp"
#include "surefoot/motion/fit/fit_model.hpp"
#include "surefoot/motion/fit/published_fit.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

struct CalibrationOptions {
  ModelFitOptions model = {};
  Vec<3> noise_scale{0.08, 0.04, 0.4};   // commands that count as speed 1 in the noise [m, m, rad]
  Vec<3> first_noise{0.01, 0.01, 0.05};  // first guess of its deviation per cycle [m, m, rad]
  int rounds = 3;                        // of model and noise in turn
};

/// Throws MotionError, naming the field.
void check(const CalibrationOptions& options);

/// A calibration of a model whose type is known at run time only.
struct AnyCalibration {
  AnyMotionModel model;
  Eigen::MatrixXd covariance = {};  // of its parameters
  MotionNoise noise = {};           // constant, normal: what the weights of the poses are made from
  double log_likelihood = 0;        // of all measured poses [nats]

  Eigen::VectorXd standard_errors() const { return roots_of_diagonal<Eigen::Dynamic>(covariance); }
};

template <MotionModel M>
struct Calibration {
  M model;
  typename ModelFit<M>::Covariance covariance;  // of its parameters
  MotionNoise noise;                            // constant, normal: what the weights of the poses are made from
  double log_likelihood = 0;                    // of all measured poses [nats]

  Vec<M::parameter_count> standard_errors() const { return roots_of_diagonal<M::parameter_count>(covariance); }
};

/// Fits model and constant noise. Cost: some ten milliseconds for 25 sequences of 25 cycles and 12 parameters.
/// Throws MotionError if a sequence cannot be used.
AnyCalibration calibrate(std::span<const WalkSequence> sequences, const CalibrationOptions& options,
                         const AnyMotionModel& start);

template <MotionModel M>
Calibration<M> calibrate(std::span<const WalkSequence> sequences, const CalibrationOptions& options = {},
                         const M& start = M()) {
  const AnyCalibration found = calibrate(sequences, options, AnyMotionModel(start));
  return {.model = found.model.as<M>(),
          .covariance = found.covariance,
          .noise = found.noise,
          .log_likelihood = found.log_likelihood};
}

template <class M>
requires(!MotionModel<M>) auto calibrate(std::span<const WalkSequence>, const CalibrationOptions& = {}) {
  return explain_motion_model<M>();
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/calibrate.ipp"
#endif
