// Definitions of surefoot/motion/plan/informative_commands.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/motion/plan/informative_commands.hpp"
#include "surefoot/motion/simulate_walk.hpp"

namespace surefoot {

SUREFOOT_INLINE std::vector<Eigen::Matrix3Xd> plan_held_commands(const CommandBounds& bounds, int sequences, int cycles,
                                                                 std::uint64_t seed) {
  constexpr std::uint32_t mean_hold = 12;  // [cycles]
  std::vector<Eigen::Matrix3Xd> plan = plan_commands(bounds, sequences, cycles, seed);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    Rng rng = Rng(seed, i).stream(1);
    Vec<3> command = Vec<3>::Zero(), target = Vec<3>::Zero();
    for (Eigen::Index cycle = 0; cycle < plan[i].cols(); ++cycle) {
      if (cycle == 0 || rng.below(mean_hold) == 0) {
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

SUREFOOT_ONCE void check(const InformativeOptions& options) {
  check(options.bounds);
  if (options.sequences < 1) {
    throw MotionError("InformativeOptions: sequences must be at least 1, got " + std::to_string(options.sequences));
  }
}

namespace detail {

/// Candidates within reach, and their information about the parameters of the tracker.
struct InformativeCandidates {
  std::vector<Eigen::Matrix3Xd> commands;
  std::vector<Eigen::MatrixXd> information;
};

SUREFOOT_INLINE InformativeCandidates informative_candidates(const MotionTracker& tracker,
                                                             const InformativeOptions& options, std::uint64_t seed) {
  check(options);
  std::vector<Eigen::Matrix3Xd> plan = plan_commands(options.bounds, options.candidates, options.cycles, seed);
  for (Eigen::Matrix3Xd& held : plan_held_commands(options.bounds, options.candidates, options.cycles, seed)) {
    plan.push_back(std::move(held));
  }
  InformativeCandidates result;
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
    result.information.push_back(linearize(tracker, sequence).information);
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
template <class Value>
std::size_t best_addition(const std::vector<Eigen::MatrixXd>& candidates, const Eigen::MatrixXd& information,
                          Value&& value) {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double here = value(Eigen::MatrixXd(information + candidates[i]));
    if (!(here > most)) continue;
    most = here;
    best = i;
  }
  return best;
}

}  // namespace detail

SUREFOOT_INLINE std::vector<Eigen::Matrix3Xd> plan_informative_commands(const MotionTracker& tracker,
                                                                        const InformativeOptions& options,
                                                                        std::uint64_t seed) {
  const detail::InformativeCandidates candidates = detail::informative_candidates(tracker, options, seed);
  const auto volume = [](const Eigen::MatrixXd& information) {
    return detail::Cholesky(information).half_log_determinant();
  };
  std::vector<Eigen::Matrix3Xd> chosen;
  Eigen::MatrixXd information = tracker.information;
  for (int s = 0; s < options.sequences; ++s) {
    const std::size_t best = detail::best_addition(candidates.information, information, volume);
    information += candidates.information[best];
    chosen.push_back(candidates.commands[best]);
  }
  return chosen;
}

SUREFOOT_INLINE CheckPlan plan_check_commands(const MotionTracker& tracker, const Eigen::VectorXd& jumps,
                                              const InformativeOptions& options, std::uint64_t seed) {
  constexpr int rounds = 3;  // of exchanging every sequence for the best
  const Eigen::Index n = tracker.model.parameter_count();
  if (jumps.size() != n) throw MotionError("plan_check_commands: jumps must have one entry per parameter");
  if (std::ranges::all_of(jumps, [](double jump) { return jump == 0; }))
    throw MotionError("plan_check_commands: jumps must not all be 0");
  const detail::InformativeCandidates candidates = detail::informative_candidates(tracker, options, seed);
  const auto seen = [&](const Eigen::MatrixXd& together) {
    Eigen::MatrixXd solution = together;
    detail::Cholesky(tracker.information + together).solve_in_place(solution);
    const Eigen::MatrixXd information = detail::multiply(tracker.information, solution);
    double smallest = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < n; ++i) {
      if (jumps[i] != 0) smallest = std::min(smallest, jumps[i] * jumps[i] * information(i, i));
    }
    return smallest;
  };
  std::vector<std::size_t> chosen;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  for (int s = 0; s < options.sequences; ++s) {
    chosen.push_back(detail::best_addition(candidates.information, information, seen));
    information += candidates.information[chosen.back()];
  }
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
