// Definitions of surefoot/motion/plan/command_plan.hpp.
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
#include "surefoot/motion/plan/command_plan.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const CommandBounds& bounds) {
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

SUREFOOT_INLINE std::vector<Eigen::Matrix3Xd> plan_commands(const CommandBounds& bounds, int sequences, int cycles,
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

SUREFOOT_INLINE std::optional<std::string> commands_within(const CommandBounds& bounds,
                                                           const Eigen::Matrix3Xd& commands, const Vec<3>& before) {
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

namespace detail {

SUREFOOT_ONCE void check_space(std::size_t sequences, int runs, double kept) {
  if (sequences == 0) throw MotionError("space_needed: there are no commands");
  if (runs < 1) throw MotionError("space_needed: runs must be at least 1, got " + std::to_string(runs));
  if (!(kept > 0 && kept <= 1)) throw MotionError("space_needed: kept must be in (0, 1], got " + std::to_string(kept));
}

SUREFOOT_INLINE Box<2> box_of_reach(const WalkReach& reach, double kept) {
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

}  // namespace detail

}  // namespace surefoot
