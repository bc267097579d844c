// Walks that a calibrated model and its noise predict, and what would be measured of them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// One walk from the origin with these commands (column = cycle) after the command `before` (x, y, turn) [m, m, rad]; calls
/// visit(cycle, pose) after each cycle. The heading of the poses is wrapped to [-pi, pi).
template <MotionModel M, NoiseModel N, class Visit>
void walk(const M& model, const N& noise, const Eigen::Matrix3Xd& commands, const Vec<3>& before, Rng& rng,
          Visit&& visit) {
  Pose2 pose;
  Vec<3> previous = before;
  for (Eigen::Index cycle = 0; cycle < commands.cols(); ++cycle) {
    const Vec<3> command = commands.col(cycle);
    const Vec<3> moved = cycle_displacement(model, command, previous).vec() + noise.sample(command, previous, rng);
    pose = pose * Pose2::from_vec(moved);
    previous = command;
    visit(cycle, pose);
  }
}

/// A sequence with these commands, every pose still to be measured or only the last; simulate_walk fills it.
inline WalkSequence planned_sequence(const Eigen::Matrix3Xd& commands, bool every_pose) {
  WalkSequence sequence{.name = "planned", .commands = commands, .poses = Eigen::Matrix3Xd::Zero(3, commands.cols())};
  return every_pose ? sequence : final_pose_only(std::move(sequence));
}

/// Walks the commands of `like` once and measures what was measured there (where its poses are numbers), with normal
/// errors of the given accuracy; a heading with a tolerance is read off as the middle of its bin.
template <MotionModel M, NoiseModel N>
WalkSequence simulate_walk(const M& model, const N& noise, const PoseAccuracy& accuracy, WalkSequence like, Rng& rng) {
  walk(model, noise, like.commands, like.command_before, rng, [&](Eigen::Index cycle, const Pose2& pose) {
    const Vec<3> error{accuracy.position * rng.normal(), accuracy.position * rng.normal(),
                       accuracy.heading * rng.normal()};
    Vec<3> reading = pose.vec() + error;
    const double bin = 2 * accuracy.heading_tolerance;
    if (bin > 0) reading[2] = bin * std::round(reading[2] / bin);
    reading[2] = wrap_angle(reading[2]);
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (std::isfinite(like.poses(i, cycle))) like.poses(i, cycle) = reading[i];
    }
  });
  return like;
}

}  // namespace surefoot
