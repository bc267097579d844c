// One iteration of RFPI as published: Hofer & Rouxel, "An operational method toward efficient walk control policies for
// humanoid robots", ICAPS 2017, Algorithms 2 to 4. Policy n is improved after n more runs; all states ever visited
// are kept; their values are the mean returns of simulated runs, learnt with constant leaves; their actions come from
// one-step lookahead over random candidates, learnt with linear leaves. An iteration costs
// states * (value_runs * horizon + candidates * samples) transitions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/solve/action_leaf.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/lookahead.hpp"
#include "surefoot/solve/rfpi_adapt.hpp"
#include "surefoot/solve/rfpi_backup.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_state.hpp"
#include "surefoot/solve/visited_states.hpp"

namespace surefoot::detail {

/// Mean discounted return of `runs` simulated runs from one state (Algorithm 3).
template <Problem P, class Acting>
double rollout_value(const P& problem, Acting act, const typename P::State& start, int runs, int horizon,
                     double discount, Rng rng, RfpiWork& work) {
  std::vector<typename P::State> at(static_cast<std::size_t>(runs), start);
  double sum = 0;
  double weight = 1;
  for (int t = 0; t < horizon && !at.empty(); ++t) {
    const auto actions = act(std::span<const typename P::State>(at));
    work.steps += at.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Step<typename P::State> step = problem.step(at[i], actions[i], rng);
      sum += weight * step.reward;
      if (!step.terminal) at[kept++] = step.next;
    }
    at.resize(kept);
    weight *= discount;
  }
  return sum / runs;
}

/// The state of affairs after one more iteration. Incomplete if `stop` was requested.
template <Problem P, Executor E>
RfpiState<P> improve_by_rollouts(const P& problem, const RfpiOptions& options, const RfpiState<P>& before,
                                 std::span<const typename P::State> seed_states, const E& executor, const Rng& rng,
                                 std::uint64_t evaluation_seed, std::stop_token stop) {
  using State = typename P::State;
  using Action = typename P::Action;
  RfpiState<P> after;
  after.work = before.work;
  const ForestPolicy<P> policy(problem, before.policy, options.agreement);
  const Box<P::action_dim> box = problem.action_box();
  // The first policy is random.
  const auto acting = [&](Rng choice) {
    return [&policy, &box, &before, choice](std::span<const State> states) mutable {
      if (!before.policy.empty()) return policy.act(states);
      std::vector<Action> actions;
      for (std::size_t i = 0; i < states.size(); ++i) actions.push_back(box.sample(choice));
      return actions;
    };
  };

  StateSamples<P>& samples = after.samples;
  samples.states =
      before.iteration == 0 ? std::vector<State>(seed_states.begin(), seed_states.end()) : before.samples.states;
  const auto visited = visited_states(
      problem, acting(rng.stream(0)),  // random only in the first iteration, which has one run
      static_cast<std::size_t>(before.iteration) + 1, options.horizon, 0.0, executor, rng.stream(1), stop);
  samples.states.insert(samples.states.end(), visited.begin(), visited.end());
  samples.values.resize(samples.size());
  samples.actions.resize(samples.size());
  std::vector<RfpiWork> done(samples.size());
  auto collect_work = [&] {
    for (const RfpiWork& part : done) {
      after.work.steps += part.steps;
      after.work.lookups += part.lookups;
    }
    done.assign(samples.size(), {});
  };
  const auto value_of = [&](std::size_t i) {
    samples.values[i] = rollout_value(problem, acting(rng.stream(2, i)), samples.states[i], options.value_runs,
                                      options.horizon, options.discount, rng.stream(3, i), done[i]);
    done[i].lookups = done[i].steps * (before.policy.empty() ? 0 : before.policy.trees());
  };
  const bool valued =
      fill(executor, samples.size(), value_of, stop, Results<double>{samples.values}, Results<RfpiWork>{done});
  if (!valued) return after;
  collect_work();
  const auto value =
      fit_value<ConstantLeaf>(problem, samples, {}, options.value_forest, executor, rng.stream(4), after.work, stop);

  const auto action_of = [&](std::size_t i) {
    Lookahead<P> look(problem, value, options.discount, options.lookahead);
    samples.actions[i] = look(samples.states[i], nullptr, rng.stream(5, i)).action;
    done[i].steps = look.transitions();
    done[i].lookups = done[i].steps * value.trees();
  };
  const bool complete =
      fill(executor, samples.size(), action_of, stop, Results<Action>{samples.actions}, Results<RfpiWork>{done});
  if (!complete) return after;
  collect_work();
  after.policy = fit_policy(problem, samples, {}, OpinionsOf::distances, options.policy_forest, executor, rng.stream(6),
                            after.work, stop);
  const int runs = evaluation_runs(options);
  after.cost = policy_cost(problem, after.policy, options, runs, executor, evaluation_seed).cost.mean;
  const std::uint64_t steps = static_cast<std::uint64_t>(runs) * static_cast<std::uint64_t>(options.horizon);
  after.work.steps += steps;
  after.work.lookups += steps * after.policy.trees();
  after.iteration = before.iteration + 1;
  return after;
}

}  // namespace surefoot::detail
