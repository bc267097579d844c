// Keeps a calibrated motion model up to date while the robot is in use: an extended Kalman filter over the parameters,
// one sequence at a time, in information form (Thrun, Burgard, Fox: "Probabilistic Robotics", 2005, section 3.5), with
// exponential forgetting and resetting (Salgado, Goodwin, Middleton: "Modified least squares algorithm incorporating
// exponential resetting and forgetting", International Journal of Control 47, 1988): before every sequence
//
//   information <- forgetting * information + (1 - forgetting) * information of the prior,
//
// so that what is not excited is forgotten no further than to the prior of the calibration, and the covariance cannot
// grow without bound. The estimate itself is left where it is. Cost: as one Jacobian of fit_model for the sequence.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "surefoot/core/vec.hpp"
#include "surefoot/motion/fit/fit_model.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// A calibrated model and how well it is known, now.
template <MotionModel M>
struct MotionTracker {
  static constexpr int n = M::parameter_count;
  using Square = Eigen::Matrix<double, n, n>;

  M model;
  Square information = prior_information();  // inverse of the covariance of the parameters
  MotionNoise noise = {};                    // of the walk
  PoseAccuracy accuracy = {};                // of the measured poses
  double forgetting = 0.98;                  // factor per sequence, in (0, 1]; 1: everything is remembered
  Square floor = prior_information();        // the information that is never forgotten

  Square covariance() const { return information.llt().solve(Square::Identity()); }
  Vec<n> standard_errors() const { return covariance().diagonal().cwiseSqrt(); }

  /// That of a calibration before its first sequence: parameters spread by `prior` widths of their ranges.
  static Square prior_information(double prior = ModelFitOptions().prior) {
    const Vec<n> deviation = prior * parameter_box<M>().width();
    return deviation.array().square().inverse().matrix().asDiagonal();
  }
};

/// Continues a calibration: its model, covariance and noise, made with these options. Throws MotionError if the
/// covariance is none.
template <MotionModel M>
MotionTracker<M> track(const M& model, const typename MotionTracker<M>::Square& covariance, const MotionNoise& noise,
                       const ModelFitOptions& options = {}) {
  using Square = typename MotionTracker<M>::Square;
  const Eigen::LLT<Square> root(covariance);
  if (!covariance.allFinite() || root.info() != Eigen::Success) {
    throw MotionError("track: the covariance of the calibration must be finite and positive definite");
  }
  MotionTracker<M> tracker{.model = model};
  tracker.information = root.solve(Square::Identity());
  tracker.noise = noise;
  tracker.accuracy = options.accuracy;
  tracker.floor = MotionTracker<M>::prior_information(options.prior);
  return tracker;
}

/// What a sequence says about the parameters, to first order about those of the tracker: the squared whitened
/// innovations are rest - 2 offset^T d + d^T information d for parameters moved by d.
template <MotionModel M>
struct SequenceSays {
  static constexpr int n = M::parameter_count;
  Vec<n> at;                                // the parameters it was worked out about
  Eigen::Matrix<double, n, n> information;  // slopes^T slopes
  Vec<n> offset;                            // slopes^T innovations
  double rest = 0;                          // innovations^T innovations
  Eigen::Index count = 0;                   // of innovations
};

/// How surprising a sequence was.
struct Surprise {
  double squared = 0;         // normalised innovation squared, the uncertainty of the parameters included
  Eigen::Index freedoms = 0;  // its mean, for a robot that walks as calibrated (it is a chi-square of as many)

  /// The same as a standard normal number: 3 is rare, 5 absurd (Wilson and Hilferty 1931).
  double deviations() const {
    const double spread = 2.0 / (9.0 * static_cast<double>(freedoms));
    return (std::cbrt(squared / static_cast<double>(freedoms)) - (1 - spread)) / std::sqrt(spread);
  }
};

/// Throws MotionError if the sequence cannot be used.
template <MotionModel M>
SequenceSays<M> listen(const MotionTracker<M>& tracker, const WalkSequence& sequence) {
  check(sequence);
  const ModelFitOptions options{.accuracy = tracker.accuracy, .prior = std::numeric_limits<double>::infinity()};
  const detail::WeightedPoses<M> poses(tracker.model, tracker.noise, options, std::span(&sequence, 1));
  SequenceSays<M> says;
  says.at = tracker.model.parameters();
  const Eigen::VectorXd innovations = poses.residuals(says.at);
  const Eigen::MatrixXd slopes = -poses.jacobian(says.at);
  says.information = slopes.transpose() * slopes;  // the rows of the prior are 0
  says.offset = slopes.transpose() * innovations;
  says.rest = innovations.squaredNorm();
  says.count = innovations.size() - M::parameter_count;
  return says;
}

/// The step in time before the next sequence.
template <MotionModel M>
void forget(MotionTracker<M>& tracker) {
  if (!(tracker.forgetting > 0 && tracker.forgetting <= 1)) {
    throw MotionError("MotionTracker: forgetting must be in (0, 1], got " + std::to_string(tracker.forgetting));
  }
  tracker.information = tracker.forgetting * tracker.information + (1 - tracker.forgetting) * tracker.floor;
}

/// How surprising it is what a sequence says, for the tracker it was worked out about.
template <MotionModel M>
Surprise surprise(const MotionTracker<M>& tracker, const SequenceSays<M>& says) {
  const typename MotionTracker<M>::Square information = tracker.information + says.information;
  return {.squared = says.rest - says.offset.dot(information.llt().solve(says.offset)), .freedoms = says.count};
}

/// Takes over what a sequence says. It may have been worked out about parameters nearby.
template <MotionModel M>
void learn(MotionTracker<M>& tracker, const SequenceSays<M>& says) {
  const Vec<M::parameter_count> now = tracker.model.parameters();
  tracker.information += says.information;
  const Vec<M::parameter_count> step =
      tracker.information.llt().solve(says.offset + says.information * (says.at - now));
  tracker.model = M::from_parameters(now + step);
}

/// Updates the tracker by one sequence and says how surprising it was. The tracker should have been calibrated: what is
/// linear about a model that is far off costs some half of a standard error. Nothing is held back: whoever mistrusts a
/// sequence asks `surprise(tracker, listen(tracker, sequence))` first. Throws MotionError if it cannot be used; the
/// tracker is then as it was.
template <MotionModel M>
Surprise update(MotionTracker<M>& tracker, const WalkSequence& sequence) {
  const SequenceSays<M> says = listen(tracker, sequence);
  forget(tracker);
  const Surprise result = surprise(tracker, says);
  learn(tracker, says);
  return result;
}

}  // namespace surefoot
