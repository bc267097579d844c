// Residuals of measured poses whose weights stay fixed, and their Jacobian: what Gauss-Newton minimises for a motion
// model. Cost of a Jacobian: two displacements per cycle and parameter.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot::detail {

/// All innovations of some sequences, one after the other, and then the deviations of the parameters from the prior.
class WeightedPoses {
 public:
  /// Weights as of the model `at`; parameters lie about their defaults by `prior` [widths of their ranges].
  WeightedPoses(const AnyMotionModel& at, const MotionNoise& noise, const PoseAccuracy& accuracy, double prior,
                std::span<const WalkSequence> sequences);

  Eigen::VectorXd residuals(const Eigen::VectorXd& parameters) const;
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& parameters) const;

 private:
  // By parameter: displacements with it a little larger, minus those with it a little smaller, over the difference.
  std::vector<Eigen::Matrix3Xd> displacement_derivatives(const Eigen::VectorXd& parameters, std::size_t sequence) const;

  template <class BeforeCycle, class Measured>
  void each_innovation(const Eigen::VectorXd& parameters, BeforeCycle&& before_cycle, Measured&& measured) const;

  AnyMotionModel model_;
  std::span<const WalkSequence> sequences_;
  std::vector<std::vector<Innovation>> weights_;  // by sequence
  std::vector<Eigen::VectorXd> shortenings_;      // by sequence and cycle
  Eigen::Index count_ = 0;                        // of innovations
  Eigen::VectorXd width_, prior_;                 // by parameter
};

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/weighted_poses.ipp"
#endif
