// Recorded sequences of the twin: many at once, on any executor.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/motion/walk_sequence.hpp"
#include "walking_twin.hpp"

namespace sigmaban {

inline constexpr double steps_per_cycle = 2;

/// Of all joints in one control cycle.
struct JointRow {
  double time = 0;                                          // [s]
  std::array<double, 12> goals{}, positions{}, currents{};  // [rad, rad, A]
};

/// One sequence, cycle by cycle. A fall ends it: the cycle of the fall is not in it.
struct TwinSequence {
  std::size_t number = 0;
  std::vector<surefoot::Vec<3>> commands;  // per step (forward, left, turn) [m, m, rad]
  std::vector<surefoot::Pose2> moved;      // in the trunk's frame at the start of the cycle [m, rad]
  bool fell = false;
  double simulated = 0;          // from the stand on [s]
  std::vector<JointRow> joints;  // where they were asked for
};

/// Walks a column of commands per cycle (what a perfect robot would do, as surefoot::plan_commands gives them). Noise
/// on targets comes from the stream `number` of the seed.
TwinSequence record_sequence(const WalkingTwinOptions& options, const Eigen::Matrix3Xd& commands, std::size_t number,
                             std::uint64_t seed, bool with_joints = false);

/// All of them, in order; those that a stop kept from being walked are missing. The same for every executor.
/// `ended(count)` is called, one call at a time, when `count` sequences are done.
template <surefoot::Executor E>
std::vector<TwinSequence> record_sequences(const WalkingTwinOptions& options,
                                           std::span<const Eigen::Matrix3Xd> commands, std::uint64_t seed,
                                           const E& executor, const std::function<void(std::size_t)>& ended = {},
                                           bool with_joints = false) {
  std::vector<std::optional<TwinSequence>> walked(commands.size());
  std::mutex one_at_a_time;
  std::size_t done = 0;
  executor.run(commands.size(), [&](std::size_t i) {
    walked[i] = record_sequence(options, commands[i], i, seed, with_joints);
    const std::scoped_lock lock(one_at_a_time);
    ++done;
    if (ended) ended(done);
  });
  std::vector<TwinSequence> result;
  for (std::optional<TwinSequence>& sequence : walked) {
    if (sequence) result.push_back(std::move(*sequence));
  }
  return result;
}

/// The pose after every cycle, seen from the trunk at the start of cycle 0.
std::vector<surefoot::Pose2> poses(const TwinSequence& sequence);

/// As calibration sees it. Throws TwinError for an empty sequence.
surefoot::WalkSequence walk_sequence(const TwinSequence& sequence);

/// CSV, one row per cycle: seq, cycle, command per step, displacement, pose at the end of the cycle. Sequences that
/// ended in a fall are left out.
std::string sequences_csv(std::span<const TwinSequence> sequences);

/// CSV of their joints, one row per control cycle: seq, time, goals, positions, currents.
std::string joints_csv(std::span<const TwinSequence> sequences);

/// Displacement = A (1, commands per cycle), fitted to the displacements of single cycles by least squares. Throws
/// TwinError for fewer than four cycles.
Eigen::Matrix<double, 3, 4> walk_gains(std::span<const TwinSequence> sequences);

/// Root mean square of what these gains leave unexplained in a cycle [m, m, rad].
surefoot::Vec<3> gains_residual(std::span<const TwinSequence> sequences, const Eigen::Matrix<double, 3, 4>& gains);

/// Root mean square of what the best gains for the commands of a cycle and of the one before it leave unexplained
/// [m, m, rad]. Throws TwinError for fewer than seven cycles.
surefoot::Vec<3> displacement_noise(std::span<const TwinSequence> sequences);

}  // namespace sigmaban
