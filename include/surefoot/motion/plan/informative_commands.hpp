// Chooses the sequences that tell most about a walk from many that were thought up. A final pose adds up 25 cycles of
// noise and tells little about commands that wander at random and cancel; commands that are held tell several times as
// much.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/plan/command_plan.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// Sequences that go to a drawn command as fast as the bounds allow, each component being 0 or one of its bounds, and
/// hold it; now and then (after 12 cycles on average) to another. Arguments, columns and errors as of plan_commands.
inline std::vector<Eigen::Matrix3Xd> plan_held_commands(const CommandBounds& bounds, int sequences, int cycles,
                                                      std::uint64_t seed) {
  std::vector<Eigen::Matrix3Xd> plan = plan_commands(bounds, sequences, cycles, seed);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    Rng rng = Rng(seed, i).stream(1);
    Vec<3> command = Vec<3>::Zero(), target = Vec<3>::Zero();
    for (Eigen::Index cycle = 0; cycle < plan[i].cols(); ++cycle) {
      if (cycle == 0 || rng.below(12) == 0) {
        for (Eigen::Index k = 0; k < 3; ++k) {
          const std::uint32_t choice = rng.below(3);
          target[k] = choice == 0 ? bounds.low[k] : choice == 1 ? 0.0 : bounds.high[k];
        }
      }
      command += (target - command).cwiseMax(-bounds.acceleration).cwiseMin(bounds.acceleration);
      plan[i].col(cycle) = command;
    }
  }
  return plan;
}

struct InformativeOptions {
  CommandBounds bounds = {};
  int sequences = 25;                                      // to choose
  int cycles = 25;                                         // of each
  bool every_pose = false;                                 // whether all poses will be measured, or the last only
  int candidates = 400;                                    // of each kind: wandering and held
  double reach = std::numeric_limits<double>::infinity();  // farthest from the start, by the model without noise [m]
};

namespace detail {

/// Candidates within reach, and their information about the parameters of the tracker.
template <MotionModel M>
struct InformativeCandidates {
  std::vector<Eigen::Matrix3Xd> commands;
  std::vector<typename MotionTracker<M>::Square> information;
};

template <MotionModel M>
InformativeCandidates<M> informative_candidates(const MotionTracker<M>& tracker, const InformativeOptions& options,
                                                std::uint64_t seed) {
  if (options.sequences < 1) {
    throw MotionError("InformativeOptions: sequences must be at least 1, got " + std::to_string(options.sequences));
  }
  std::vector<Eigen::Matrix3Xd> plan = plan_commands(options.bounds, options.candidates, options.cycles, seed);
  for (Eigen::Matrix3Xd& held : plan_held_commands(options.bounds, options.candidates, options.cycles, seed)) {
    plan.push_back(std::move(held));
  }
  InformativeCandidates<M> result;
  const MotionNoise none;
  Rng rng(seed);
  for (Eigen::Matrix3Xd& commands : plan) {
    WalkSequence sequence = planned_sequence(commands, options.every_pose);
    double farthest = 0;
    walk(tracker.model, none, commands, sequence.command_before, rng, [&](Eigen::Index cycle, const Pose2& pose) {
      farthest = std::max(farthest, pose.position().norm());
      if (sequence.position_measured(cycle)) sequence.poses.col(cycle) = pose.vec();
    });
    if (farthest > options.reach) continue;
    result.information.push_back(listen(tracker, sequence).information);
    result.commands.push_back(std::move(commands));
  }
  if (result.commands.empty()) {
    std::ostringstream text;
    text << "InformativeOptions: no candidate stays within the reach of " << options.reach
         << " m; allow more, or fewer cycles";
    throw MotionError(text.str());
  }
  return result;
}

/// The candidate for which value(information + its own) is largest.
template <class Square, class Value>
std::size_t best_addition(const std::vector<Square>& candidates, const Square& information, Value&& value) {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double here = value(Square(information + candidates[i]));
    if (!(here > most)) continue;
    most = here;
    best = i;
  }
  return best;
}

}  // namespace detail

/// Commands to calibrate from, one matrix per sequence (as plan_commands): greedy D-optimal design (Fedorov, "Theory of
/// Optimal Experiments", 1972), one sequence after the other such that the determinant of the information grows most,
/// from what the tracker knows: for a robot not yet calibrated, one of the default model. The information is worked out
/// at the tracker's parameters. Throws MotionError for bounds and counts that plan_commands refuses, and if no candidate
/// stays within reach. Cost: one Jacobian of fit_model per candidate, one factorisation per candidate and sequence.
template <MotionModel M>
std::vector<Eigen::Matrix3Xd> plan_informative_commands(const MotionTracker<M>& tracker,
                                                      const InformativeOptions& options, std::uint64_t seed) {
  using Square = typename MotionTracker<M>::Square;
  const auto candidates = detail::informative_candidates(tracker, options, seed);
  const auto volume = [](const Square& information) {
    return information.llt().matrixLLT().diagonal().array().log().sum();
  };
  std::vector<Eigen::Matrix3Xd> chosen;
  Square information = tracker.information;
  for (int s = 0; s < options.sequences; ++s) {
    const std::size_t best = detail::best_addition(candidates.information, information, volume);
    information += candidates.information[best];
    chosen.push_back(candidates.commands[best]);
  }
  return chosen;
}

/// Commands that a calibrated robot walks again and again to show that nothing has changed.
struct CheckPlan {
  std::vector<Eigen::Matrix3Xd> commands;
  double seen = 0;  // non-centrality of the change that is hardest to see, over all sequences; an alarm needs some 45
};

/// Chosen such that the change of a single parameter that is hardest to see among `jumps` (0: not watched) is seen
/// best: the smallest non-centrality of the test of change_alarm.hpp is made as large as exchanging single sequences
/// can make it. Errors and cost as above, several times.
template <MotionModel M>
CheckPlan plan_check_commands(const MotionTracker<M>& tracker, const Vec<M::parameter_count>& jumps,
                            const InformativeOptions& options, std::uint64_t seed) {
  using Square = typename MotionTracker<M>::Square;
  if (!(jumps.array() != 0).any()) throw MotionError("plan_check_commands: jumps must not all be 0");
  const auto candidates = detail::informative_candidates(tracker, options, seed);
  const Square& known = tracker.information;
  const auto seen = [&](const Square& together) {
    const Square information = known * (known + together).llt().solve(together);
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < M::parameter_count; ++i) {
      if (jumps[i] != 0) smallest = std::min(smallest, jumps[i] * jumps[i] * information(i, i));
    }
    return smallest;
  };
  std::vector<std::size_t> chosen;
  Square information = Square::Zero();
  for (int s = 0; s < options.sequences; ++s) {
    chosen.push_back(detail::best_addition(candidates.information, information, seen));
    information += candidates.information[chosen.back()];
  }
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t& one : chosen) {
      information -= candidates.information[one];
      one = detail::best_addition(candidates.information, information, seen);
      information += candidates.information[one];
    }
  }
  CheckPlan plan{.commands = {}, .seen = seen(information)};
  for (const std::size_t one : chosen) plan.commands.push_back(candidates.commands[one]);
  return plan;
}

}  // namespace surefoot
