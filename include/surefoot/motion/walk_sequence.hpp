// A recorded sequence: the command of each walk cycle, and the pose measured in the end or after every cycle.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"

namespace surefoot {

/// The robot starts at the origin, looking along x. Column i is cycle i.
struct WalkSequence {
  std::string name = {};                   // for messages: file, or number of the sequence
  Eigen::Matrix3Xd commands = {};          // commanded displacement of each cycle (x, y, turn) [m, m, rad]
  Eigen::Matrix3Xd poses = {};             // pose after each cycle (x, y, heading) [m, m, rad]; NaN: not measured
  Vec<3> command_before = Vec<3>::Zero();  // the commands before the first cycle, e.g. walking on the spot

  Eigen::Index cycles() const { return commands.cols(); }
  Vec<3> previous_command(Eigen::Index cycle) const {
    return cycle == 0 ? command_before : Vec<3>(commands.col(cycle - 1));
  }
  bool position_measured(Eigen::Index cycle) const {
    return std::isfinite(poses(0, cycle)) && std::isfinite(poses(1, cycle));
  }
  bool heading_measured(Eigen::Index cycle) const { return std::isfinite(poses(2, cycle)); }
};

/// Throws MotionError, naming the sequence, unless it has cycles, finite commands and a position after its last cycle.
void check(const WalkSequence& sequence);

/// Checks each, and that there is at least one.
void check(std::span<const WalkSequence> sequences);

/// The sequence as a tape measures it: all poses but the last are forgotten.
WalkSequence final_pose_only(WalkSequence sequence);

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

/// Throws MotionError, naming the field, unless all are finite and none is negative.
void check(const PoseAccuracy& accuracy);

/// The pose after the last cycle, if the robot moves exactly as the model predicts. Cost: one displacement per cycle.
Pose2 predict_final_pose(const AnyMotionModel& model, const WalkSequence& sequence);

namespace detail {

/// Displacements by the model, by sequence (column = cycle).
std::vector<Eigen::Matrix3Xd> displacements(const AnyMotionModel& model, std::span<const WalkSequence> sequences);

}  // namespace detail

/// How far a model misses final poses: root mean squares of distances [m] and of angles [rad] (over the sequences whose
/// heading was measured; NaN without any).
struct FinalPoseError {
  double position = 0;
  double heading = 0;
};

namespace detail {

/// The pose after all displacements (column = cycle), from the origin.
Pose2 compose(const Eigen::Matrix3Xd& displacements);

}  // namespace detail

/// Distances of angles below `heading_tolerance` [rad] count as none.
FinalPoseError final_pose_error(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                                double heading_tolerance = 0);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/walk_sequence.ipp"
#endif
