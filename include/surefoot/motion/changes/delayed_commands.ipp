// Definitions of surefoot/motion/changes/delayed_commands.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/motion/changes/delayed_commands.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE WalkSequence without_first(const WalkSequence& sequence, Eigen::Index cycles) {
  if (cycles == 0 || sequence.cycles() <= cycles) return sequence;
  if (!sequence.position_measured(cycles - 1) || !sequence.heading_measured(cycles - 1)) return sequence;
  const Eigen::Index left = sequence.cycles() - cycles;
  WalkSequence rest{.name = sequence.name, .command_before = sequence.commands.col(cycles - 1)};
  rest.commands.resize(3, left);
  rest.poses.resize(3, left);
  const Vec<3> start = sequence.poses.col(cycles - 1);
  const Pose2 from = Pose2::from_vec(start).inverse();
  for (Eigen::Index i = 0; i < left; ++i) {
    const Vec<3> pose = sequence.poses.col(cycles + i);
    const Vec<2> position = from.transform(pose.head<2>());
    const double turned = pose[2] - start[2];
    rest.commands.col(i) = sequence.commands.col(cycles + i);
    rest.poses.col(i) << position, std::isfinite(turned) ? wrap_angle(turned) : turned;
  }
  return rest;
}

SUREFOOT_INLINE std::vector<WalkSequence> delayed(std::span<const WalkSequence> sequences, int cycles, int first) {
  std::vector<WalkSequence> result;
  for (const WalkSequence& sequence : sequences) {
    WalkSequence late = sequence;
    for (Eigen::Index i = 0; i < sequence.cycles(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        late.commands(axis, i) = i < cycles ? sequence.command_before[axis] : sequence.commands(axis, i - cycles);
      }
    }
    result.push_back(without_first(late, std::max(first, cycles == 0 ? 0 : cycles + 1)));
  }
  return result;
}

SUREFOOT_INLINE bool commands_vary(std::span<const WalkSequence> sequences) {
  constexpr double least_share = 0.1;  // of the variance of commands, that is within sequences
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double sum = 0, squares = 0, within = 0, count = 0;
    for (const WalkSequence& sequence : sequences) {
      const auto row = sequence.commands.row(axis);
      sum += row.sum();
      squares += row.squaredNorm();
      within += (row.array() - row.mean()).matrix().squaredNorm();
      count += static_cast<double>(row.size());
    }
    const double whole = squares - sum * sum / std::max(count, 1.0);
    if (within > 0 && within > least_share * whole) return true;
  }
  return false;
}

SUREFOOT_INLINE std::vector<int> possible_delays(int former, int largest) {
  std::vector<int> delays{0};
  for (int delay = 0; delay <= largest; ++delay) {
    if (delay != former) delays.push_back(delay - former);
  }
  return delays;
}

}  // namespace surefoot::detail
