// Maximum likelihood of a motion model whose noise is known: Gauss-Newton on the innovations of all sequences, whose
// weights follow the model (iteratively reweighted least squares). Cost of an iteration: two displacements per cycle
// and parameter.
#pragma once

#include <Eigen/Core>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"
#include "surefoot/optimize/robust_loss.hpp"

namespace surefoot {

struct ModelFitOptions {
  PoseAccuracy accuracy = {};  // of the measured poses
  Loss loss = Loss::squared;   // huber keeps wrong readings from deciding
  double prior = 0.25;         // parameters lie about their defaults, by this [widths of their ranges]; inf: anywhere
  int max_iterations = 20;     // of new weights
};

/// Throws MotionError, naming the field.
void check(const ModelFitOptions& options);

/// A fit of a model whose type is known at run time only.
struct AnyModelFit {
  AnyMotionModel model;
  Eigen::MatrixXd covariance = {};  // of the parameters, for the noise that was given
  double cost = 0;                  // half the sum of the losses
  bool converged = false;

  Eigen::VectorXd standard_errors() const { return covariance.diagonal().cwiseSqrt(); }
};

template <MotionModel M>
struct ModelFit {
  using Covariance = Eigen::Matrix<double, M::parameter_count, M::parameter_count>;
  M model;
  Covariance covariance;  // of the parameters, for the noise that was given
  double cost = 0;        // half the sum of the losses
  bool converged = false;

  Vec<M::parameter_count> standard_errors() const { return covariance.diagonal().cwiseSqrt(); }
};

/// Fits the model from `start` on. Throws MotionError if a sequence cannot be used.
AnyModelFit fit_model(std::span<const WalkSequence> sequences, const MotionNoise& noise, const ModelFitOptions& options,
                      const AnyMotionModel& start);

template <MotionModel M>
ModelFit<M> fit_model(std::span<const WalkSequence> sequences, const MotionNoise& noise,
                      const ModelFitOptions& options = {}, const M& start = M()) {
  const AnyModelFit fit = fit_model(sequences, noise, options, AnyMotionModel(start));
  return {.model = fit.model.as<M>(), .covariance = fit.covariance, .cost = fit.cost, .converged = fit.converged};
}

template <class M>
requires(!MotionModel<M>) auto fit_model(std::span<const WalkSequence>, const MotionNoise&,
                                         const ModelFitOptions& = {}) {
  return explain_motion_model<M>();
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/fit_model.ipp"
#endif
