// Definitions of surefoot/motion/fit/pose_filter.hpp.
#pragma once

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
  Innovation::Values error(count);
  for (Eigen::Index i = 0; i < count; ++i) error[i] = sequence.poses(i, cycle) - pose[i];
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

// Cholesky of 2 x 2 and 3 x 3, by hand: in the innermost loop of every fit.

/// Replaces the lower triangle of a positive definite matrix by its factor.
SUREFOOT_INLINE void factorise_small(Innovation::Square& a) {
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    double squares = 0;
    for (Eigen::Index j = 0; j < k; ++j) squares += a(k, j) * a(k, j);
    a(k, k) = std::sqrt(a(k, k) - squares);
    for (Eigen::Index i = k + 1; i < a.rows(); ++i) {
      double sum = 0;
      for (Eigen::Index j = 0; j < k; ++j) sum += a(i, j) * a(k, j);
      a(i, k) = (a(i, k) - sum) / a(k, k);
    }
  }
}

/// Replaces x by the solution of lower y = x, or of lower^T y = x.
SUREFOOT_INLINE void solve_lower_small(const Innovation::Square& lower, double* x) {
  for (Eigen::Index i = 0; i < lower.rows(); ++i) {
    x[i] *= 1 / lower(i, i);
    for (Eigen::Index r = i + 1; r < lower.rows(); ++r) x[r] -= x[i] * lower(r, i);
  }
}

SUREFOOT_INLINE void solve_upper_small(const Innovation::Square& lower, double* x) {
  for (Eigen::Index i = lower.rows(); i-- > 0;) {
    double sum = 0;
    for (Eigen::Index r = i + 1; r < lower.rows(); ++r) sum += lower(r, i) * x[r];
    x[i] = (x[i] - sum) * (1 / lower(i, i));
  }
}

/// Adds a x to `result`, for a matrix of up to three rows and columns.
template <class Small>
void add_product(const Small& a, const double* x, double* result) {
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    double sum = 0;
    for (Eigen::Index k = 0; k < a.cols(); ++k) sum += a(i, k) * x[k];
    result[i] += sum;
  }
}

SUREFOOT_INLINE std::vector<Innovation> innovations(const Eigen::Matrix3Xd& displacements, const MotionNoise& noise,
                                                    const PoseAccuracy& accuracy, const WalkSequence& sequence) {
  constexpr double least_variance = 1e-14;  // [m^2, rad^2]: without any noise the expected pose would be certain
  std::vector<Innovation> result;
  Vec<3> pose = Vec<3>::Zero(), previous = sequence.command_before;
  PoseMoments moments;
  Vec<3> measured_variance = accuracy.variance();
  for (double& variance : measured_variance) variance += least_variance;
  for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
    const Vec<3> command = sequence.commands.col(cycle);
    const Pose2 displacement = Pose2::from_vec(displacements.col(cycle));
    Vec<3> variance = noise.deviation(command, previous);
    for (double& v : variance) v = v * v + least_variance;
    moments.move(pose, displacement, variance);
    previous = command;
    if (!sequence.position_measured(cycle)) continue;

    const Eigen::Index count = sequence.heading_measured(cycle) ? 3 : 2;
    Innovation innovation;
    innovation.cycle = cycle;
    innovation.error = pose_error(sequence, cycle, pose, count);
    Eigen::Matrix3d covariance = moments.covariance();
    Innovation::Square expected(count, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      for (Eigen::Index i = 0; i < count; ++i) expected(i, k) = covariance(i, k);
      expected(k, k) += measured_variance[k];
    }
    factorise_small(expected);
    innovation.whitening = Innovation::Square::Identity(count, count);
    double logs = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      solve_lower_small(expected, &innovation.whitening(0, k));
      logs += std::log(innovation.whitening(k, k));
    }
    innovation.log_det = -2 * logs;
    innovation.gain.resize(3, count);
    for (Eigen::Index k = 0; k < 3; ++k) {
      Innovation::Values column(count);
      for (Eigen::Index i = 0; i < count; ++i) column[i] = covariance(i, k);
      solve_lower_small(expected, column.data());
      solve_upper_small(expected, column.data());
      for (Eigen::Index i = 0; i < count; ++i) innovation.gain(k, i) = column[i];
    }
    add_product(innovation.gain, innovation.error.data(), pose.data());
    for (Eigen::Index k = 0; k < 3; ++k) {
      Vec<3> taken = Vec<3>::Zero();
      add_product(innovation.gain, &covariance(0, k), taken.data());
      for (Eigen::Index i = 0; i < 3; ++i) covariance(i, k) -= taken[i];
    }
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
      double squares = 0;
      for (const double value : innovation.whitened()) squares += value * value;
      sum -= 0.5 * (squares + innovation.log_det + static_cast<double>(innovation.error.size()) * log_two_pi);
    }
  }
  return sum;
}

}  // namespace detail

SUREFOOT_INLINE Innovation::Values Innovation::whitened() const {
  Values result = Values::Zero(error.size());
  detail::add_product(whitening, error.data(), result.data());
  return result;
}

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
