// Definitions of surefoot/motion/fit/weighted_poses.hpp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/fit/pose_moments.hpp"
#include "surefoot/motion/fit/weighted_poses.hpp"

namespace surefoot::detail {

/// By cycle: how much shorter its displacement becomes in the mean, since the heading is unsure before it.
SUREFOOT_INLINE Eigen::VectorXd shortenings(const WalkSequence& sequence, const std::vector<Innovation>& weights,
                                            const MotionNoise& noise) {
  Eigen::VectorXd result(sequence.cycles());
  auto weight = weights.begin();
  double variance = 0;
  for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
    result[cycle] = shortening(variance);
    const double turn = noise.deviation(sequence.commands.col(cycle), sequence.previous_command(cycle))[2];
    variance += turn * turn;
    if (weight == weights.end() || weight->cycle != cycle) continue;
    variance = weight->heading_variance;
    ++weight;
  }
  return result;
}

SUREFOOT_INLINE WeightedPoses::WeightedPoses(const AnyMotionModel& at, const MotionNoise& noise,
                                             const PoseAccuracy& accuracy, double prior,
                                             std::span<const WalkSequence> sequences)
    : model_(at), sequences_(sequences), width_(at.parameter_box().high() - at.parameter_box().low()) {
  for (const WalkSequence& sequence : sequences) {
    weights_.push_back(innovations(at, noise, accuracy, sequence));
    for (const Innovation& innovation : weights_.back()) count_ += innovation.error.size();
    shortenings_.push_back(shortenings(sequence, weights_.back(), noise));
  }
  prior_ = width_;
  for (double& deviation : prior_) deviation *= prior;
}

/// Follows every sequence: before_cycle(sequence, cycle, pose, expected displacement), and measured(weight, error)
/// wherever a pose was measured.
template <class BeforeCycle, class Measured>
void WeightedPoses::each_innovation(const Eigen::VectorXd& parameters, BeforeCycle&& before_cycle,
                                    Measured&& measured) const {
  Eigen::Matrix3Xd displacements;
  for (std::size_t i = 0; i < sequences_.size(); ++i) {
    const WalkSequence& sequence = sequences_[i];
    model_.displacements(parameters, sequence.commands, sequence.command_before, displacements);
    Vec<3> pose = Vec<3>::Zero();
    auto weight = weights_[i].begin();
    for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
      Pose2 displacement = Pose2::from_vec(displacements.col(cycle));
      displacement.x *= shortenings_[i][cycle];
      displacement.y *= shortenings_[i][cycle];
      before_cycle(i, cycle, pose, displacement);
      pose = moved(pose, displacement);
      if (weight == weights_[i].end() || weight->cycle != cycle) continue;
      const Innovation::Values error = pose_error(sequence, cycle, pose, weight->error.size());
      measured(*weight, error);
      add_product(weight->gain, error.data(), pose.data());
      ++weight;
    }
  }
}

SUREFOOT_INLINE Eigen::VectorXd WeightedPoses::residuals(const Eigen::VectorXd& parameters) const {
  const Eigen::Index n = model_.parameter_count();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(count_ + n);
  Eigen::Index next = 0;
  each_innovation(
      parameters, [](std::size_t, Eigen::Index, const Vec<3>&, const Pose2&) {},
      [&](const Innovation& weight, const Innovation::Values& error) {
        add_product(weight.whitening, error.data(), &result[next]);
        next += error.size();
      });
  for (Eigen::Index i = 0; i < n; ++i) {
    result[count_ + i] = (parameters[i] - model_.default_parameters()[i]) / prior_[i];
  }
  return result;
}

SUREFOOT_INLINE std::vector<Eigen::Matrix3Xd> WeightedPoses::displacement_derivatives(const Eigen::VectorXd& parameters,
                                                                                      std::size_t sequence) const {
  const WalkSequence& walked = sequences_[sequence];
  std::vector<Eigen::Matrix3Xd> result;
  Eigen::VectorXd shifted = parameters;
  Eigen::Matrix3Xd below;
  for (Eigen::Index k = 0; k < parameters.size(); ++k) {
    const double step = 1e-5 * width_[k];
    Eigen::Matrix3Xd above;
    shifted[k] = parameters[k] + step;
    model_.displacements(shifted, walked.commands, walked.command_before, above);
    shifted[k] = parameters[k] - step;
    model_.displacements(shifted, walked.commands, walked.command_before, below);
    shifted[k] = parameters[k];
    for (Eigen::Index i = 0; i < above.size(); ++i) above.data()[i] = (above.data()[i] - below.data()[i]) / (2 * step);
    result.push_back(std::move(above));
  }
  return result;
}

SUREFOOT_INLINE Eigen::MatrixXd WeightedPoses::jacobian(const Eigen::VectorXd& parameters) const {
  const Eigen::Index n = model_.parameter_count();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count_ + n, n);
  for (Eigen::Index k = 0; k < n; ++k) result(count_ + k, k) = 1 / prior_[k];
  std::vector<Eigen::Matrix3Xd> derivatives;
  Eigen::Matrix3Xd pose_jacobian(3, n);
  Eigen::Index next = 0;
  each_innovation(
      parameters,
      [&](std::size_t i, Eigen::Index cycle, const Vec<3>& pose, const Pose2& displacement) {
        if (cycle == 0) {
          derivatives = displacement_derivatives(parameters, i);
          pose_jacobian.setZero();
        }
        const Eigen::Matrix3d by_pose = jacobian_by_pose(pose, displacement);
        const Eigen::Matrix3d by_displacement = jacobian_by_displacement(pose);
        for (Eigen::Index k = 0; k < n; ++k) {
          Vec<3> derivative = derivatives[static_cast<std::size_t>(k)].col(cycle), moved = Vec<3>::Zero();
          derivative[0] *= shortenings_[i][cycle];
          derivative[1] *= shortenings_[i][cycle];
          add_product(by_pose, &pose_jacobian(0, k), moved.data());
          add_product(by_displacement, derivative.data(), moved.data());
          for (Eigen::Index row = 0; row < 3; ++row) pose_jacobian(row, k) = moved[row];
        }
      },
      [&](const Innovation& weight, const Innovation::Values& error) {
        const Eigen::Index size = error.size();
        for (Eigen::Index k = 0; k < n; ++k) {
          Vec<3> whitened = Vec<3>::Zero(), taken = Vec<3>::Zero();
          add_product(weight.whitening, &pose_jacobian(0, k), whitened.data());
          add_product(weight.gain, &pose_jacobian(0, k), taken.data());
          for (Eigen::Index row = 0; row < size; ++row) result(next + row, k) = -whitened[row];
          for (Eigen::Index row = 0; row < 3; ++row) pose_jacobian(row, k) -= taken[row];
        }
        next += size;
      });
  return result;
}

}  // namespace surefoot::detail
