// What measured poses say about a motion model: each against the pose to be expected after all that was measured before
// it in the sequence, in units of how well that is known. A Kalman filter whose state is the pose; the noise of the
// walk is its process noise (Thrun, Burgard, Fox: "Probabilistic Robotics", 2005, chapters 5 and 7), its moments
// between measurements are exact. One filter serves recordings with a final pose only and with a pose after every
// cycle.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/motion/fit/pose_spread.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// How well a pose is measured.
struct PoseAccuracy {
  double position = 0.005;       // standard deviation of x and of y [m]
  double heading = 0.02;         // standard deviation [rad]
  double heading_tolerance = 0;  // half width of the bins that headings are sorted into [rad]

  Vec<3> variance() const {
    const double binned = heading_tolerance * heading_tolerance / 3;
    return {position * position, position * position, heading * heading + binned};
  }
};

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

  Values whitened() const { return whitening * error; }
};

namespace detail {

/// measured - expected, of the first `count` components.
inline Innovation::Values pose_error(const WalkSequence& sequence, Eigen::Index cycle, const Vec<3>& pose,
                                     Eigen::Index count) {
  Innovation::Values error = sequence.poses.col(cycle).head(count) - pose.head(count);
  if (count == 3) error[2] = wrap_angle(error[2]);
  return error;
}

/// Derivative of pose * displacement by the pose.
inline Eigen::Matrix3d pose_slope(const Vec<3>& pose, const Pose2& displacement) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();
  slope(0, 2) = -s * displacement.x - c * displacement.y;
  slope(1, 2) = c * displacement.x - s * displacement.y;
  return slope;
}

/// Derivative of pose * displacement by the displacement.
inline Eigen::Matrix3d displacement_slope(const Vec<3>& pose) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  return Eigen::Matrix3d{{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
}

inline Vec<3> moved(const Vec<3>& pose, const Pose2& displacement) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  return {pose[0] + c * displacement.x - s * displacement.y, pose[1] + s * displacement.x + c * displacement.y,
          pose[2] + displacement.angle};
}

}  // namespace detail

/// All innovations of a sequence. Cost: some hundred operations per cycle.
template <MotionModel M>
std::vector<Innovation> innovations(const M& model, const MotionNoise& noise, const PoseAccuracy& accuracy,
                                    const WalkSequence& sequence) {
  constexpr double least_variance = 1e-14;  // [m^2, rad^2]: without any noise the expected pose would be certain
  std::vector<Innovation> result;
  Vec<3> pose = Vec<3>::Zero(), previous = sequence.command_before;
  detail::PoseSpread spread;
  const Vec<3> measured_variance = accuracy.variance().array() + least_variance;
  for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
    const Vec<3> commands = sequence.commands.col(cycle);
    const Pose2 displacement = cycle_displacement(model, commands, previous);
    const Vec<3> variance = noise.deviation(commands, previous).array().square() + least_variance;
    spread.move(pose, displacement, variance);
    previous = commands;
    if (!sequence.position_measured(cycle)) continue;

    const Eigen::Index count = sequence.heading_measured(cycle) ? 3 : 2;
    Innovation innovation;
    innovation.cycle = cycle;
    innovation.error = detail::pose_error(sequence, cycle, pose, count);
    Eigen::Matrix3d covariance = spread.covariance();
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
    spread = detail::PoseSpread(covariance, pose[2]);
    result.push_back(innovation);
  }
  return result;
}

/// Logarithm of the probability density of what was measured [nats], for normal noise of the given deviations.
template <MotionModel M>
double log_likelihood(const M& model, const MotionNoise& noise, const PoseAccuracy& accuracy,
                      std::span<const WalkSequence> sequences) {
  const double log_two_pi = std::log(2 * std::numbers::pi);
  double sum = 0;
  for (const WalkSequence& sequence : sequences) {
    for (const Innovation& innovation : innovations(model, noise, accuracy, sequence)) {
      sum -= 0.5 * (innovation.whitened().squaredNorm() + innovation.log_det +
                    static_cast<double>(innovation.error.size()) * log_two_pi);
    }
  }
  return sum;
}

}  // namespace surefoot
