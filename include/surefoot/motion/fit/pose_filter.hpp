// Innovations of measured poses: each against the pose to be expected after all that was measured before
// it in the sequence, in units of how well that is known. A Kalman filter whose state is the pose; the noise of the
// walk is its process noise (Thrun, Burgard, Fox: "Probabilistic Robotics", 2005, chapters 5 and 7), its moments
// between measurements are exact. One filter serves recordings with a final pose only and with a pose after every
// cycle.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// A measured pose against the expected one. Two components without a measured heading, else three.
struct Innovation {
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  using Gain = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;

  Eigen::Index cycle = 0;
  Values error;                 // measured - expected (x, y, heading) [m, m, rad]
  Square whitening;             // makes `error` a vector of independent components of deviation 1
  Gain gain;                    // what of `error` is taken over into the pose
  double log_det = 0;           // of the covariance of `error`
  double heading_variance = 0;  // what the heading is still unsure by after the measurement [rad^2]

  Values whitened() const;
};

namespace detail {

/// measured - expected, of the first `count` components.
Innovation::Values pose_error(const WalkSequence& sequence, Eigen::Index cycle, const Vec<3>& pose, Eigen::Index count);

/// Derivative of pose * displacement by the pose, and by the displacement.
Eigen::Matrix3d jacobian_by_pose(const Vec<3>& pose, const Pose2& displacement);
Eigen::Matrix3d jacobian_by_displacement(const Vec<3>& pose);

/// pose * displacement, with an angle that is not wrapped.
Vec<3> moved(const Vec<3>& pose, const Pose2& displacement);

/// As below, of a model with these displacements (column = cycle).
std::vector<Innovation> innovations(const Eigen::Matrix3Xd& displacements, const MotionNoise& noise,
                                    const PoseAccuracy& accuracy, const WalkSequence& sequence);
double log_likelihood(std::span<const Eigen::Matrix3Xd> displacements, const MotionNoise& noise,
                      const PoseAccuracy& accuracy, std::span<const WalkSequence> sequences);

}  // namespace detail

/// All innovations of a sequence. Cost: some hundred operations per cycle.
std::vector<Innovation> innovations(const AnyMotionModel& model, const MotionNoise& noise, const PoseAccuracy& accuracy,
                                    const WalkSequence& sequence);

/// Logarithm of the probability density of what was measured [nats], for normal noise of the given deviations.
double log_likelihood(const AnyMotionModel& model, const MotionNoise& noise, const PoseAccuracy& accuracy,
                      std::span<const WalkSequence> sequences);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/pose_filter.ipp"
#endif
