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
constexpr double survived_share = 0.5;

/// The greatest of `exploration`, half of it, a quarter of it and so on with which runs last on average at least
/// survived_share of `length`, that of the policy's own runs [transitions]. Its work is counted; `trees`: of the
/// policy.
template <Problem P, Executor E>
double survived_exploration(const P& problem, const ActOnBatch<P>& policy, std::size_t trees, double exploration,
                            double length, int horizon, const E& executor, const Rng& rng, RfpiWork& work,
                            const std::stop_token& stop) {
  constexpr std::size_t runs = 32;  // of each chance that is tried
  constexpr int most_halvings = 6;  // to a 64th: 0.005 per step of the usual 0.3
  for (int halvings = 0; halvings < most_halvings; ++halvings, exploration /= 2) {
    const auto states = visited_states(problem, policy, runs, horizon, exploration, executor,
                                       rng.stream(static_cast<std::uint64_t>(halvings)), stop, RunEnd::state_box);
    work.steps += states.size();
    work.lookups += states.size() * trees;
    if (static_cast<double>(states.size()) >= survived_share * length * static_cast<double>(runs)) break;
  }
  return exploration;
}

}  // namespace surefoot::detail
