// Definitions of surefoot/motion/fit/pose_filter.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/motion/fit/pose_moments.hpp"

namespace surefoot {

namespace detail {

/// measured - expected, of the first `count` components.
SUREFOOT_INLINE Innovation::Values pose_error(const WalkSequence& sequence, Eigen::Index cycle, const Vec<3>& pose,
                                              Eigen::Index count) {
  Innovation::Values error = sequence.poses.col(cycle).head(count) - pose.head(count);
  if (count == 3) error[2] = wrap_angle(error[2]);
  return error;
}

/// Derivative of pose * displacement by the pose.
SUREFOOT_INLINE Eigen::Matrix3d jacobian_by_pose(const Vec<3>& pose, const Pose2& displacement) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian(0, 2) = -s * displacement.x - c * displacement.y;
  jacobian(1, 2) = c * displacement.x - s * displacement.y;
  return jacobian;
}

/// Derivative of pose * displacement by the displacement.
SUREFOOT_INLINE Eigen::Matrix3d jacobian_by_displacement(const Vec<3>& pose) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  return Eigen::Matrix3d{{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
}

SUREFOOT_INLINE Vec<3> moved(const Vec<3>& pose, const Pose2& displacement) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  return {pose[0] + c * displacement.x - s * displacement.y, pose[1] + s * displacement.x + c * displacement.y,
          pose[2] + displacement.angle};
}

SUREFOOT_INLINE std::vector<Innovation> innovations(const Eigen::Matrix3Xd& displacements, const MotionNoise& noise,
                                                    const PoseAccuracy& accuracy, const WalkSequence& sequence) {
  constexpr double least_variance = 1e-14;  // [m^2, rad^2]: without any noise the expected pose would be certain
  std::vector<Innovation> result;
  Vec<3> pose = Vec<3>::Zero(), previous = sequence.command_before;
  PoseMoments moments;
  const Vec<3> measured_variance = accuracy.variance().array() + least_variance;
  for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
    const Vec<3> command = sequence.commands.col(cycle);
    const Pose2 displacement = Pose2::from_vec(displacements.col(cycle));
    const Vec<3> variance = noise.deviation(command, previous).array().square() + least_variance;
    moments.move(pose, displacement, variance);
    previous = command;
    if (!sequence.position_measured(cycle)) continue;

    const Eigen::Index count = sequence.heading_measured(cycle) ? 3 : 2;
    Innovation innovation;
    innovation.cycle = cycle;
    innovation.error = pose_error(sequence, cycle, pose, count);
    Eigen::Matrix3d covariance = moments.covariance();
    Innovation::Square expected = covariance.topLeftCorner(count, count);
    expected.diagonal() += measured_variance.head(count);
    const Eigen::LLT<Innovation::Square> root(expected);
    innovation.whitening = Innovation::Square::Identity(count, count);
    root.matrixL().solveInPlace(innovation.whitening);
    innovation.log_det = -2 * innovation.whitening.diagonal().array().log().sum();
    innovation.gain = root.solve(covariance.topRows(count)).transpose();
    pose += innovation.gain * innovation.error;
    covariance -= (innovation.gain * covariance.topRows(count)).eval();
    innovation.heading_variance = std::max(0.0, covariance(2, 2));
    moments = PoseMoments(covariance, pose[2]);
    result.push_back(innovation);
  }
  return result;
}

SUREFOOT_INLINE double log_likelihood(std::span<const Eigen::Matrix3Xd> displacements, const MotionNoise& noise,
                                      const PoseAccuracy& accuracy, std::span<const WalkSequence> sequences) {
  const double log_two_pi = std::log(2 * std::numbers::pi);
  double sum = 0;
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    for (const Innovation& innovation : innovations(displacements[i], noise, accuracy, sequences[i])) {
      sum -= 0.5 * (innovation.whitened().squaredNorm() + innovation.log_det +
                    static_cast<double>(innovation.error.size()) * log_two_pi);
    }
  }
  return sum;
}

}  // namespace detail

SUREFOOT_INLINE std::vector<Innovation> innovations(const AnyMotionModel& model, const MotionNoise& noise,
                                                    const PoseAccuracy& accuracy, const WalkSequence& sequence) {
  return detail::innovations(model.displacements(sequence.commands, sequence.command_before), noise, accuracy,
                             sequence);
}

SUREFOOT_INLINE double log_likelihood(const AnyMotionModel& model, const MotionNoise& noise,
                                      const PoseAccuracy& accuracy, std::span<const WalkSequence> sequences) {
  return detail::log_likelihood(detail::displacements(model, sequences), noise, accuracy, sequences);
}

}  // namespace surefoot
