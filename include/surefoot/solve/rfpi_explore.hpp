// The chance of exploration that the runs of an iteration survive.
// Where random actions soon end a run (a pole falls), exploring runs never come to what the policy does later (balance
// it in the middle of the track), and all samples are of how runs begin and of falls. Where a policy reaches a goal,
// exploring runs last longer than its own and nothing is taken back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_state.hpp"
#include "surefoot/solve/visited_states.hpp"

namespace surefoot::detail {

/// Exploring runs last at least this share of the policy's own.
constexpr double survived_share = 0.4;

/// The greatest of `exploration`, 1 / less of it and so on with which runs last on average at least survived_share of
/// `length`, that of the policy's own runs [transitions]; if none does, the last. Its work is counted; `trees`: of the
/// policy.
template <Problem P, Executor E>
double survived_exploration(const P& problem, const ActOnBatch<P>& policy, std::size_t trees, double exploration,
                            double length, int horizon, const E& executor, const Rng& rng, RfpiWork& work,
                            const std::stop_token& stop) {
  constexpr std::size_t runs = 32;  // of each chance that is tried
  constexpr double less = 1.41;     // factor between those: two of them halve it
  constexpr int most_steps = 6;     // to an eighth: with still less of it, samples are of one path alone
  for (int i = 0; i < most_steps; ++i, exploration /= less) {
    const auto states = visited_states(problem, policy, runs, horizon, exploration, executor,
                                       rng.stream(static_cast<std::uint64_t>(i)), stop, RunEnd::state_box);
    work.steps += states.size();
    work.lookups += states.size() * trees;
    if (static_cast<double>(states.size()) >= survived_share * length * static_cast<double>(runs)) break;
  }
  return exploration;
}

}  // namespace surefoot::detail
