// Trials of whether lookaheads should follow the policy for some transitions before the value counts.
// Where a policy holds what it controls (a balanced pole), runs that begin with different actions come together again,
// and with them the errors of the values, which else outweigh what an action changes. Where it does not yet, to follow
// a poor policy hides what an action is worth, and costs several times as much.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/lookahead.hpp"
#include "surefoot/solve/rfpi_learn.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_state.hpp"

namespace surefoot::detail {

/// Transitions of the policy that a lookahead follows: as many as backups have at least without noise.
constexpr int followed = least_backup_steps;

/// Iterations from one trial of the other way to the next, and states for each that a trial looks at: it costs about as
/// much as the lookaheads of one iteration, and the other way has to do better with fewer samples.
constexpr int trial_every = 4;

/// Every fourth of the samples' states with actions from lookaheads of `options`.
template <Problem P, Executor E>
StateSamples<P> look_ahead_from_some(const P& problem, const RfpiOptions& options, const RfpiState<P>& before,
                                     const ForestPolicy<P>& policy, const StateSamples<P>& samples, const E& executor,
                                     const Rng& rng, RfpiWork& work, std::stop_token stop) {
  constexpr std::size_t states_per_job = 16;
  StateSamples<P> some;
  for (std::size_t i = 0; i < samples.size(); i += trial_every) some.states.push_back(samples.states[i]);
  const std::size_t count = some.size();
  some.actions.resize(count);
  some.values.resize(count);
  const std::vector<typename P::Action> incumbents = policy.act(some.states);
  fill(
      executor, (count + states_per_job - 1) / states_per_job,
      [&](std::size_t job) {
        Lookahead<P> look(problem, before.value, options.discount, options.lookahead, &policy);
        for (std::size_t i = job * states_per_job; i < std::min(count, (job + 1) * states_per_job); ++i) {
          some.actions[i] = look(some.states[i], &incumbents[i], rng.stream(i)).action;
        }
      },
      std::move(stop), Results<typename P::Action>{some.actions, states_per_job});
  const Lookahead<P> look(problem, before.value, options.discount, options.lookahead, &policy);
  work.steps += count * look.transitions();
  work.lookups +=
      count * (look.values() * before.value.trees() + (1 + look.policy_actions()) * policy.forest().trees());
  return some;
}

/// Learns a policy from lookaheads that follow the policy where the others of this iteration do not, and the reverse;
/// takes it, and the way it came about from now on, if it does better than the one that costs `usual`. The cost of the
/// policy that is taken.
template <Problem P, Executor E>
PolicyCost try_other_way(const P& problem, RfpiOptions options, const RfpiState<P>& before, RfpiState<P>& after,
                         const ForestPolicy<P>& policy, const PolicyCost& usual, const E& executor, const Rng& rng,
                         std::uint64_t evaluation_seed, std::stop_token stop) {
  options.lookahead.follow = before.follows ? 0 : followed;
  const StateSamples<P> some =
      look_ahead_from_some(problem, options, before, policy, after.samples, executor, rng.stream(0), after.work, stop);
  options.policy_forest.max_leaves = after.leaves;
  auto another = fit_policy(problem, some, StateSamples<P>{}, after.opinions, options.policy_forest, executor,
                            rng.stream(1), after.work, std::move(stop));
  const PolicyCost cost = counted_cost(problem, another, options, executor, evaluation_seed, after.work);
  if (cost.discounted >= usual.discounted) return usual;
  after.policy = std::move(another);
  after.follows = !before.follows;
  return cost;
}

}  // namespace surefoot::detail
