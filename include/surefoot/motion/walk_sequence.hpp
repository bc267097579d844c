// One recorded sequence: what was commanded in each walk cycle, and where the robot was found, in the end or after every
// cycle.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "surefoot/core/error.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/core/pose2.hpp"

namespace surefoot {

/// Wrong sequences, models or options handed to the motion area.
struct MotionError : Error {
  using Error::Error;
};

/// The robot starts at the origin, looking along x. Column i is cycle i.
struct WalkSequence {
  std::string name = {};                 // for messages: file, or number of the sequence
  Eigen::Matrix3Xd commands = {};          // commanded displacement of each cycle (x, y, turn) [m, m, rad]
  Eigen::Matrix3Xd poses = {};           // pose after each cycle (x, y, heading) [m, m, rad]; NaN: not measured
  Vec<3> command_before = Vec<3>::Zero();  // the commands before the first cycle, e.g. walking on the spot

  Eigen::Index cycles() const { return commands.cols(); }
  Vec<3> previous_command(Eigen::Index cycle) const { return cycle == 0 ? command_before : Vec<3>(commands.col(cycle - 1)); }
  bool position_measured(Eigen::Index cycle) const {
    return std::isfinite(poses(0, cycle)) && std::isfinite(poses(1, cycle));
  }
  bool heading_measured(Eigen::Index cycle) const { return std::isfinite(poses(2, cycle)); }
};

/// Throws MotionError, naming the sequence, unless it has cycles, finite commands and a position after its last cycle.
inline void check(const WalkSequence& sequence) {
  const auto fail = [&](const std::string& what) { throw MotionError("sequence " + sequence.name + ": " + what); };
  if (sequence.cycles() == 0) fail("has no cycle");
  if (sequence.poses.cols() != sequence.cycles()) fail("must have one column of poses per cycle");
  if (!sequence.commands.allFinite() || !sequence.command_before.allFinite()) fail("has a command that is not a number");
  if (!sequence.position_measured(sequence.cycles() - 1)) {
    fail("has no final position; measure where the robot stopped, or leave the sequence out");
  }
}

/// Checks each, and that there is at least one.
inline void check(std::span<const WalkSequence> sequences) {
  if (sequences.empty()) throw MotionError("there is no sequence to calibrate from");
  for (const WalkSequence& sequence : sequences) check(sequence);
}

/// The sequence as a tape measures it: all poses but the last are forgotten.
inline WalkSequence final_pose_only(WalkSequence sequence) {
  if (sequence.cycles() > 1) sequence.poses.leftCols(sequence.cycles() - 1).setConstant(std::nan(""));
  return sequence;
}

/// The pose after the last cycle, if the robot moves exactly as the model says. Cost: one displacement per cycle.
template <MotionModel M>
Pose2 predict_final_pose(const M& model, const WalkSequence& sequence) {
  Pose2 pose;
  Vec<3> previous = sequence.command_before;
  for (const auto& column : sequence.commands.colwise()) {
    const Vec<3> commands = column;
    pose = pose * cycle_displacement(model, commands, previous);
    previous = commands;
  }
  return pose;
}

/// How far a model misses final poses: root mean squares of distances [m] and of angles [rad] (over the sequences whose
/// heading was measured; NaN without any).
struct FinalPoseError {
  double position = 0;
  double heading = 0;
};

/// Distances of angles below `heading_tolerance` [rad] count as none.
template <MotionModel M>
FinalPoseError final_pose_error(const M& model, std::span<const WalkSequence> sequences, double heading_tolerance = 0) {
  double position = 0, heading = 0;
  int headings = 0;
  for (const WalkSequence& sequence : sequences) {
    const Pose2 predicted = predict_final_pose(model, sequence);
    const auto measured = sequence.poses.col(sequence.cycles() - 1);
    position += (predicted.position() - measured.head<2>()).squaredNorm();
    if (!std::isfinite(measured[2])) continue;
    const double angle = std::max(0.0, std::abs(wrap_angle(predicted.angle - measured[2])) - heading_tolerance);
    heading += angle * angle;
    ++headings;
  }
  const auto count = static_cast<double>(sequences.size());
  return {std::sqrt(position / count), headings > 0 ? std::sqrt(heading / headings) : std::nan("")};
}

}  // namespace surefoot
