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

namespace surefoot {

SUREFOOT_INLINE Eigen::MatrixXd prior_information(const AnyMotionModel& model, double prior) {
  const Eigen::VectorXd deviation = prior * model.parameter_box().width();
  return deviation.array().square().inverse().matrix().asDiagonal();
}

SUREFOOT_INLINE Eigen::MatrixXd MotionTracker::covariance() const { return detail::Cholesky(information).inverse(); }

SUREFOOT_INLINE MotionTracker track(const AnyMotionModel& model, const Eigen::MatrixXd& covariance,
                                    const MotionNoise& noise, const ModelFitOptions& options) {
  const Eigen::Index n = model.parameter_count();
  if (covariance.rows() != n || covariance.cols() != n) {
    throw MotionError("track: the covariance of the calibration must have a row and a column per parameter");
  }
  const detail::Cholesky root(covariance);
  if (!covariance.allFinite() || !root.ok()) {
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
  const Eigen::MatrixXd jacobian = -poses.jacobian(update.at);
  update.information = jacobian.transpose() * jacobian;  // the rows of the prior are 0
  update.offset = jacobian.transpose() * innovations;
  update.rest = innovations.squaredNorm();
  update.count = innovations.size() - tracker.model.parameter_count();
  return update;
}

SUREFOOT_INLINE void forget(MotionTracker& tracker) {
  if (!(tracker.forgetting > 0 && tracker.forgetting <= 1)) {
    throw MotionError("MotionTracker: forgetting must be in (0, 1], got " + std::to_string(tracker.forgetting));
  }
  tracker.information = tracker.forgetting * tracker.information + (1 - tracker.forgetting) * tracker.floor;
}

SUREFOOT_INLINE Surprise surprise(const MotionTracker& tracker, const InformationUpdate& update) {
  const detail::Cholesky root(tracker.information + update.information);
  return {.squared = update.rest - detail::dot(update.offset, root.solve(update.offset)), .freedoms = update.count};
}

SUREFOOT_INLINE void learn(MotionTracker& tracker, const InformationUpdate& update) {
  const Eigen::VectorXd now = tracker.model.parameters();
  tracker.information += update.information;
  const Eigen::VectorXd right = update.offset + detail::multiply(update.information, Eigen::VectorXd(update.at - now));
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
