// Plans the experiment that calibrates a walk: commands that wander at random through all that the robot may be told, and
// the room that it needs for them. Hofer and Rouxel, "An Operational Method Toward Efficient Walk Control Policies for
// Humanoid Robots", ICAPS 2017, section 4: every cycle adds a random acceleration to the command, within the bounds.
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
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// What a robot may be commanded per walk cycle (x, y, turn). The defaults are Sigmaban's, a cycle being two steps.
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
inline void check(const CommandBounds& bounds) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::string name(detail::command_components[static_cast<std::size_t>(i)].name);
    const auto fail = [&](const std::string& field, const std::string& what, double value) {
      std::ostringstream text;
      text << "CommandBounds: " << field << " of " << name << " must be " << what << ", got " << value;
      throw MotionError(text.str());
    };
    if (!std::isfinite(bounds.low[i]) || bounds.low[i] > 0) fail("low", "a finite number up to 0", bounds.low[i]);
    if (!std::isfinite(bounds.high[i]) || bounds.high[i] < 0) fail("high", "a finite number from 0 on", bounds.high[i]);
    const double largest = bounds.acceleration[i];
    if (!std::isfinite(largest) || largest < 0) fail("acceleration", "a finite number from 0 on", largest);
    if (largest == 0 && bounds.high[i] > bounds.low[i])
      fail("acceleration", "above 0 for commands that may vary", largest);
  }
}

/// `sequences` random walks of `cycles` commands each (column = cycle; x, y, turn [m, m, rad]), from standing still.
/// Sequence i depends on the seed and i alone: a longer plan begins with the shorter one. Throws MotionError for bounds
/// that fail the check and for counts below 1.
inline std::vector<Eigen::Matrix3Xd> plan_commands(const CommandBounds& bounds, int sequences, int cycles,
                                                 std::uint64_t seed) {
  check(bounds);
  if (sequences < 1) {
    throw MotionError("plan_commands: sequences must be at least 1, got " + std::to_string(sequences));
  }
  if (cycles < 1) throw MotionError("plan_commands: cycles must be at least 1, got " + std::to_string(cycles));
  const Box<3> range(bounds.low, bounds.high);
  const Box<3> accelerations = Box<3>::symmetric(bounds.acceleration);
  std::vector<Eigen::Matrix3Xd> plan;
  for (int i = 0; i < sequences; ++i) {
    Rng rng(seed, i);
    Eigen::Matrix3Xd commands(3, cycles);
    Vec<3> command = Vec<3>::Zero();
    for (auto column : commands.colwise()) {
      command = range.clamp(command + accelerations.sample(rng));
      column = command;
    }
    plan.push_back(std::move(commands));
  }
  return plan;
}

/// The first order that breaks the bounds, as a sentence; nothing if all keep them. `before` is the order before the
/// first. A millionth of a unit is forgiven, for commands that were written down.
inline std::optional<std::string> commands_within(const CommandBounds& bounds, const Eigen::Matrix3Xd& commands,
                                                const Vec<3>& before = Vec<3>::Zero()) {
  check(bounds);
  constexpr double forgiven = 1e-6;
  Vec<3> previous = before;
  for (Eigen::Index cycle = 0; cycle < commands.cols(); ++cycle) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto [name, unit] = detail::command_components[static_cast<std::size_t>(i)];
      const double command = commands(i, cycle), change = command - previous[i];
      std::ostringstream text;
      text << "cycle " << cycle + 1 << ": the command " << name << " = " << command << ' ' << unit;
      if (!std::isfinite(command)) {
        text << " is not a number";
      } else if (command < bounds.low[i] - forgiven || command > bounds.high[i] + forgiven) {
        text << " lies outside [" << bounds.low[i] << ", " << bounds.high[i] << "]";
      } else if (std::abs(change) > bounds.acceleration[i] + forgiven) {
        text << " differs by " << change << " from the one before, more than the " << bounds.acceleration[i]
             << " allowed";
      } else {
        continue;
      }
      return text.str();
    }
    previous = commands.col(cycle);
  }
  return std::nullopt;
}

/// The room around the start (x forward, y left [m]) that the robot's centre does not leave in the share `kept` of
/// walks, if every sequence is walked `runs` times; each of the four sides is left about equally often. Throws
/// MotionError without commands or runs, or for a share outside (0, 1]. Cost: one displacement per cycle and run.
template <MotionModel M, NoiseModel N>
Box<2> space_needed(const M& model, const N& noise, std::span<const Eigen::Matrix3Xd> commands, int runs,
                    std::uint64_t seed, double kept = 0.99) {
  if (commands.empty()) throw MotionError("space_needed: there are no commands");
  if (runs < 1) throw MotionError("space_needed: runs must be at least 1, got " + std::to_string(runs));
  if (!(kept > 0 && kept <= 1)) throw MotionError("space_needed: kept must be in (0, 1], got " + std::to_string(kept));
  std::array<std::vector<double>, 4> reach;  // how far each walk gets to the right, back, left and ahead [m]
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
  auto sorted = reach;
  for (auto& side : sorted) std::sort(side.begin(), side.end());
  const std::size_t walks = reach[0].size();
  const auto inside = [&](std::size_t rank) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < walks; ++i) {
      bool in = true;
      for (std::size_t side = 0; side < 4; ++side) in = in && reach[side][i] <= sorted[side][rank];
      count += in ? 1 : 0;
    }
    return static_cast<double>(count);
  };
  std::size_t low = 0, high = walks - 1;  // the lowest rank that is enough
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (inside(middle) >= kept * static_cast<double>(walks)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return {{-sorted[0][high], -sorted[1][high]}, {sorted[2][high], sorted[3][high]}};
}

}  // namespace surefoot
