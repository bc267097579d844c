// Definitions of surefoot/motion/monitor/recursive_update.hpp.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/fit/weighted_poses.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_INLINE Eigen::MatrixXd prior_information(const AnyMotionModel& model, double prior) {
  const Eigen::VectorXd deviation = detail::times(prior, model.parameter_box().width());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(deviation.size(), deviation.size());
  for (Eigen::Index i = 0; i < deviation.size(); ++i) information(i, i) = 1 / (deviation[i] * deviation[i]);
  return information;
}

SUREFOOT_INLINE Eigen::MatrixXd MotionTracker::covariance() const { return detail::Cholesky(information).inverse(); }

SUREFOOT_INLINE MotionTracker track(const AnyMotionModel& model, const Eigen::MatrixXd& covariance,
                                    const MotionNoise& noise, const ModelFitOptions& options) {
  const Eigen::Index n = model.parameter_count();
  if (covariance.rows() != n || covariance.cols() != n) {
    throw MotionError("track: the covariance of the calibration must have a row and a column per parameter");
  }
  const detail::Cholesky root(covariance);
  if (!all_finite(covariance) || !root.ok()) {
    throw MotionError("track: the covariance of the calibration must be finite and positive definite");
  }
  MotionTracker tracker{.model = model};
  tracker.information = root.inverse();
  tracker.noise = noise;
  tracker.accuracy = options.accuracy;
  tracker.floor = prior_information(model, options.prior);
  return tracker;
}

SUREFOOT_INLINE InformationUpdate linearize(const MotionTracker& tracker, const WalkSequence& sequence) {
  check(sequence);
  constexpr double no_prior = std::numeric_limits<double>::infinity();
  const detail::WeightedPoses poses(tracker.model, tracker.noise, tracker.accuracy, no_prior, std::span(&sequence, 1));
  InformationUpdate update;
  update.at = tracker.model.parameters();
  const Eigen::VectorXd innovations = poses.residuals(update.at);
  const Eigen::MatrixXd jacobian = poses.jacobian(update.at);           // of what innovations lose
  update.information = detail::transposed_product(jacobian, jacobian);  // the rows of the prior are 0
  update.offset = detail::times(-1, detail::transposed_product(jacobian, innovations));
  update.rest = detail::dot(innovations.data(), innovations.data(), innovations.size());
  update.count = innovations.size() - tracker.model.parameter_count();
  return update;
}

SUREFOOT_INLINE void forget(MotionTracker& tracker) {
  if (!(tracker.forgetting > 0 && tracker.forgetting <= 1)) {
    throw MotionError("MotionTracker: forgetting must be in (0, 1], got " + std::to_string(tracker.forgetting));
  }
  for (Eigen::Index i = 0; i < tracker.information.size(); ++i) {
    double& value = tracker.information.data()[i];
    value = tracker.forgetting * value + (1 - tracker.forgetting) * tracker.floor.data()[i];
  }
}

SUREFOOT_INLINE Surprise surprise(const MotionTracker& tracker, const InformationUpdate& update) {
  const detail::Cholesky root(tracker.information + update.information);
  return {.squared = update.rest - detail::dot(update.offset, root.solve(update.offset)), .freedoms = update.count};
}

SUREFOOT_INLINE void learn(MotionTracker& tracker, const InformationUpdate& update) {
  const Eigen::VectorXd now = tracker.model.parameters();
  tracker.information += update.information;
  Eigen::VectorXd right = update.offset;
  right += detail::multiply(update.information, Eigen::VectorXd(update.at - now));
  tracker.model = tracker.model.with_parameters(now + detail::Cholesky(tracker.information).solve(right));
}

SUREFOOT_INLINE Surprise update(MotionTracker& tracker, const WalkSequence& sequence) {
  const InformationUpdate information = linearize(tracker, sequence);
  forget(tracker);
  const Surprise result = surprise(tracker, information);
  learn(tracker, information);
  return result;
}

}  // namespace surefoot
