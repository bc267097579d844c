// Definitions of surefoot/motion/walk_sequence.hpp.
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
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const WalkSequence& sequence) {
  const auto fail = [&](const std::string& what) { throw MotionError("sequence " + sequence.name + ": " + what); };
  if (sequence.cycles() == 0) fail("has no cycle");
  if (sequence.poses.cols() != sequence.cycles()) fail("must have one column of poses per cycle");
  if (!all_finite(sequence.commands) || !all_finite(sequence.command_before))
    fail("has a command that is not a number");
  if (!sequence.position_measured(sequence.cycles() - 1)) {
    fail("has no final position; measure where the robot stopped, or leave the sequence out");
  }
}

SUREFOOT_ONCE void check(std::span<const WalkSequence> sequences) {
  if (sequences.empty()) throw MotionError("there is no sequence to calibrate from");
  for (const WalkSequence& sequence : sequences) check(sequence);
}

SUREFOOT_INLINE WalkSequence final_pose_only(WalkSequence sequence) {
  if (sequence.cycles() > 1) std::fill_n(sequence.poses.data(), 3 * (sequence.cycles() - 1), std::nan(""));
  return sequence;
}

SUREFOOT_ONCE void check(const PoseAccuracy& accuracy) {
  const auto demand = [](double value, const char* field) {
    if (!(value >= 0 && std::isfinite(value))) {
      throw MotionError(std::string("PoseAccuracy: ") + field + " must be a finite number from 0 on, got " +
                        std::to_string(value));
    }
  };
  demand(accuracy.position, "position");
  demand(accuracy.heading, "heading");
  demand(accuracy.heading_tolerance, "heading_tolerance");
}

namespace detail {

SUREFOOT_INLINE Pose2 compose(const Eigen::Matrix3Xd& displacements) {
  Pose2 pose;
  for (Eigen::Index i = 0; i < displacements.cols(); ++i) pose = pose * Pose2::from_vec(displacements.col(i));
  return pose;
}

SUREFOOT_INLINE std::vector<Eigen::Matrix3Xd> displacements(const AnyMotionModel& model,
                                                            std::span<const WalkSequence> sequences) {
  std::vector<Eigen::Matrix3Xd> result;
  for (const WalkSequence& sequence : sequences) {
    result.push_back(model.displacements(sequence.commands, sequence.command_before));
  }
  return result;
}

}  // namespace detail

SUREFOOT_INLINE Pose2 predict_final_pose(const AnyMotionModel& model, const WalkSequence& sequence) {
  return detail::compose(model.displacements(sequence.commands, sequence.command_before));
}

SUREFOOT_INLINE FinalPoseError final_pose_error(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                                                double heading_tolerance) {
  double position = 0, heading = 0;
  int headings = 0;
  Eigen::Matrix3Xd displacements;
  for (const WalkSequence& sequence : sequences) {
    model.displacements(sequence.commands, sequence.command_before, displacements);
    const Pose2 predicted = detail::compose(displacements);
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
