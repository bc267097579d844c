// Plans of experiments that calibrate a walk: commands that wander at random through all that the robot may be told,
// and the room that it needs for them. Hofer and Rouxel, "An Operational Method Toward Efficient Walk Control Policies
// for Humanoid Robots", ICAPS 2017, section 4: every cycle adds a random acceleration to the command, within the
// bounds.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// Bounds of the commands per walk cycle (x, y, turn). The defaults are Sigmaban's, a cycle being two steps.
struct CommandBounds {
  Vec<3> low{-0.04, -0.04, -0.4};        // [m, m, rad]
  Vec<3> high{0.08, 0.04, 0.4};          // [m, m, rad]
  Vec<3> acceleration{0.04, 0.02, 0.3};  // largest change from one cycle to the next [m, m, rad]
};

namespace detail {

struct CommandComponent {
  std::string_view name, unit;
};
inline constexpr std::array<CommandComponent, 3> command_components{{{"dx", "m"}, {"dy", "m"}, {"turn", "rad"}}};

}  // namespace detail

/// Throws MotionError, naming the field, unless standing still lies in the bounds and every command can be reached.
void check(const CommandBounds& bounds);

/// `sequences` random walks of `cycles` commands each (column = cycle; x, y, turn [m, m, rad]), from standing still.
/// Sequence i depends on the seed and i alone: a longer plan begins with the shorter one. Throws MotionError for bounds
/// that fail the check and for counts below 1.
std::vector<Eigen::Matrix3Xd> plan_commands(const CommandBounds& bounds, int sequences, int cycles, std::uint64_t seed);

/// The first order that breaks the bounds, as a sentence; nothing if all keep them. `before` is the order before the
/// first. A millionth of a unit is forgiven, for commands that were written down.
std::optional<std::string> commands_within(const CommandBounds& bounds, const Eigen::Matrix3Xd& commands,
                                           const Vec<3>& before = Vec<3>::Zero());

namespace detail {

/// How far each walk gets to the right, back, left and ahead [m].
using WalkReach = std::array<std::vector<double>, 4>;

/// Throws MotionError without commands or runs, or for a share outside (0, 1].
void check_space(std::size_t sequences, int runs, double kept);

/// The box (x, y) that the share `kept` of the walks does not leave.
Box<2> box_of_reach(const WalkReach& reach, double kept);

}  // namespace detail

/// The room around the start (x forward, y left [m]) that the robot's centre does not leave in the share `kept` of
/// walks, if every sequence is walked `runs` times; each of the four sides is left about equally often. Throws
/// MotionError without commands or runs, or for a share outside (0, 1]. Cost: one displacement per cycle and run.
template <NoiseModel N>
Box<2> space_needed(const AnyMotionModel& model, const N& noise, std::span<const Eigen::Matrix3Xd> commands, int runs,
                    std::uint64_t seed, double kept = 0.99) {
  detail::check_space(commands.size(), runs, kept);
  detail::WalkReach reach;
  for (std::size_t s = 0; s < commands.size(); ++s) {
    for (int run = 0; run < runs; ++run) {
      Rng rng(seed, s, run);
      Eigen::Array4d farthest = Eigen::Array4d::Zero();
      walk(model, noise, commands[s], Vec<3>::Zero(), rng, [&](Eigen::Index, const Pose2& pose) {
        farthest = farthest.max(Eigen::Array4d(-pose.x, -pose.y, pose.x, pose.y));
      });
      for (std::size_t side = 0; side < 4; ++side) reach[side].push_back(farthest[static_cast<Eigen::Index>(side)]);
    }
  }
  return detail::box_of_reach(reach, kept);
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/plan/command_plan.ipp"
#endif
