// Definitions of surefoot/motion/simulate_walk.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/simulate_walk.hpp"

namespace surefoot {

SUREFOOT_INLINE WalkSequence planned_sequence(const Eigen::Matrix3Xd& commands, bool every_pose) {
  WalkSequence sequence{.name = "planned", .commands = commands, .poses = Eigen::Matrix3Xd::Zero(3, commands.cols())};
  return every_pose ? sequence : final_pose_only(std::move(sequence));
}

namespace detail {

SUREFOOT_INLINE void measure_pose(const Pose2& pose, const PoseAccuracy& accuracy, Rng& rng,
                                  Eigen::Ref<Vec<3>> measured) {
  const Vec<3> error{accuracy.position * rng.normal(), accuracy.position * rng.normal(),
                     accuracy.heading * rng.normal()};
  Vec<3> reading = pose.vec() + error;
  const double bin = 2 * accuracy.heading_tolerance;
  if (bin > 0) reading[2] = bin * std::round(reading[2] / bin);
  reading[2] = wrap_angle(reading[2]);
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (std::isfinite(measured[i])) measured[i] = reading[i];
  }
}

}  // namespace detail

}  // namespace surefoot
