// Walks that a calibrated model and its noise predict, and what would be measured of them.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// One walk from the origin with these commands (column = cycle) after the command `before` (x, y, turn) [m, m, rad];
/// calls visit(cycle, pose) after each cycle. The heading of the poses is wrapped to [-pi, pi).
template <NoiseModel N, class Visit>
void walk(const AnyMotionModel& model, const N& noise, const Eigen::Matrix3Xd& commands, const Vec<3>& before, Rng& rng,
          Visit&& visit) {
  const Eigen::Matrix3Xd displacements = model.displacements(commands, before);
  Pose2 pose;
  Vec<3> previous = before;
  for (Eigen::Index cycle = 0; cycle < commands.cols(); ++cycle) {
    const Vec<3> command = commands.col(cycle);
    const Vec<3> moved = displacements.col(cycle) + noise.sample(command, previous, rng);
    pose = pose * Pose2::from_vec(moved);
    previous = command;
    visit(cycle, pose);
  }
}

/// A sequence with these commands, every pose still to be measured or only the last; simulate_walk fills it.
WalkSequence planned_sequence(const Eigen::Matrix3Xd& commands, bool every_pose);

namespace detail {

/// Writes what is measured of `pose` into a column of `measured`, where it is finite.
void measure_pose(const Pose2& pose, const PoseAccuracy& accuracy, Rng& rng, Eigen::Ref<Vec<3>> measured);

}  // namespace detail

/// Walks the commands of `like` once and measures what was measured there (where its poses are numbers), with normal
/// errors of the given accuracy; a heading with a tolerance is read off as the middle of its bin.
template <NoiseModel N>
WalkSequence simulate_walk(const AnyMotionModel& model, const N& noise, const PoseAccuracy& accuracy, WalkSequence like,
                           Rng& rng) {
  walk(model, noise, like.commands, like.command_before, rng, [&](Eigen::Index cycle, const Pose2& pose) {
    detail::measure_pose(pose, accuracy, rng, like.poses.col(cycle));
  });
  return like;
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/simulate_walk.ipp"
#endif
