// One iteration of RFPI by value backups, the default: new states, one lookahead each that gives both an action and a
// value on top of the last value forest, a few simulated steps of the policy that carry the value further than one
// step, then two forests. Against the paper's rollouts of whole runs a state costs ten times less, and from V = 0,
// which is optimistic where rewards are costs, information spreads by a few steps per iteration.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/solve/action_leaf.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/lookahead.hpp"
#include "surefoot/solve/rfpi_adapt.hpp"
#include "surefoot/solve/rfpi_explore.hpp"
#include "surefoot/solve/rfpi_follow.hpp"
#include "surefoot/solve/rfpi_hold.hpp"
#include "surefoot/solve/rfpi_learn.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_state.hpp"
#include "surefoot/solve/visited_states.hpp"

namespace surefoot::detail {

/// Draws `count` elements without repetition, in random order.
template <class T>
std::vector<T> random_subset(std::vector<T> items, std::size_t count, Rng& rng) {
  count = std::min(count, items.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(items[i], items[i + rng.below(static_cast<std::uint32_t>(items.size() - i))]);
  }
  items.resize(count);
  return items;
}

/// The states of an iteration: some from the whole box, some that the policy visits now, half of those while its runs
/// are in transition (else runs that have arrived and stay fill the samples), some from before. Runs end
/// where they leave the box: a policy that is not stable yet would fill the samples with states from ever further away,
/// whose values are so large that what a forest gets wrong about them hides the differences where it matters.
template <Problem P, Executor E>
std::vector<typename P::State> choose_states(const P& problem, const RfpiOptions& options, const RfpiState<P>& before,
                                             std::size_t count, std::span<const typename P::State> seed_states,
                                             const E& executor, const Rng& rng, RfpiWork& work, std::stop_token stop) {
  std::vector<typename P::State> states;
  const bool initial = before.iteration < options.initial_iterations;
  Rng choice = rng.stream(0);
  if (before.iteration == 0) states = random_subset(std::vector(seed_states.begin(), seed_states.end()), count, choice);
  const auto wanted = static_cast<std::size_t>(options.visited_share * static_cast<double>(count));
  // About `some` states, of the first `transitions` of runs.
  const auto visit = [&](const ActOnBatch<P>& acting, double exploration, std::size_t some, int transitions,
                         const Rng& runs_rng) {
    if (!options.replace_short_runs) {
      const std::size_t runs = some / static_cast<std::size_t>(transitions) + 1;
      return visited_states(problem, acting, runs, transitions, exploration, executor, runs_rng, stop,
                            RunEnd::state_box);
    }
    return enough_visited_states(problem, acting, some, transitions, exploration, executor, runs_rng, stop,
                                 RunEnd::state_box);
  };
  if (!initial) {
    const ForestPolicy<P> policy(problem, before.policy, options.agreement);
    const ActOnBatch<P> acting = [&](std::span<const typename P::State> some) { return policy.act(some); };
    const double exploration =
        !options.adapt ? options.exploration
                       : survived_exploration(problem, acting, before.policy.trees(), options.exploration,
                                              before.length, options.horizon, executor, rng.stream(2), work, stop);
    const bool has_transient = options.adapt && before.transient > 0 && before.transient < options.horizon;
    const std::size_t of_whole_runs = has_transient ? wanted / 2 : wanted;
    states = visit(acting, exploration, of_whole_runs, options.horizon, rng.stream(1));
    if (has_transient) {
      const auto early = visit(acting, exploration, wanted - of_whole_runs, before.transient, rng.stream(3));
      states.insert(states.end(), early.begin(), early.end());
    }
    work.steps += states.size();
    work.lookups += states.size() * before.policy.trees();
  } else {
    // Every action is random, held for some steps.
    const auto visited = visit([](auto some) { return std::vector<typename P::Action>(some.size()); }, 1.0,
                               wanted, options.horizon, rng.stream(1));
    work.steps += visited.size();
    const auto some = random_subset(visited, std::min(wanted, count - std::min(count, states.size())), choice);
    states.insert(states.end(), some.begin(), some.end());
  }
  const std::size_t from_box = initial ? count - std::min(count, states.size())
                                       : static_cast<std::size_t>(options.box_share * static_cast<double>(count));
  const Box<P::state_dim> box = problem.state_box();
  for (std::size_t i = 0; i < from_box; ++i) states.push_back(box.sample(choice));
  if (states.size() < count) {
    const auto kept = random_subset(before.samples.states, count - states.size(), choice);
    states.insert(states.end(), kept.begin(), kept.end());
  }
  return states;
}

/// Puts states that share leaves next to each other: large forests are then read from the cache that the states before
/// have filled, and not from memory again for every state.
template <Problem P, class F>
void sort_by_leaves(const P& problem, const F& forest, std::vector<typename P::State>& states) {
  if (forest.empty()) return;
  std::vector<std::uint32_t> leaves(forest.trees());
  std::vector<std::pair<std::uint32_t, std::size_t>> order(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    forest.leaf_indices(features(problem, states[i]), leaves);
    order[i] = {leaves[0], i};
  }
  std::ranges::sort(order);
  std::vector<typename P::State> sorted;
  sorted.reserve(states.size());
  for (const auto& [leaf, i] : order) sorted.push_back(states[i]);
  states = std::move(sorted);
}

/// Mean return of short runs that start with the given actions, follow the policy, and end on the value forest.
template <Problem P, class Value>
void backup_values(const P& problem, const RfpiOptions& options, const ForestPolicy<P>& policy, const Value& value,
                   std::span<const typename P::State> states, std::span<const typename P::Action> actions,
                   std::span<double> values, Rng rng, RfpiWork& work) {
  const auto runs = static_cast<std::size_t>(options.backup_runs);
  const std::size_t count = states.size() * runs;
  std::vector<typename P::State> at(count);
  std::vector<std::size_t> live(count);
  std::vector<typename P::Action> chosen(count);
  std::vector<double> total(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    at[i] = states[i / runs];
    chosen[i] = actions[i / runs];
    live[i] = i;
  }
  double weight = 1;
  for (int t = 0; t <= options.backup_steps && !live.empty(); ++t) {
    if (t > 0) {
      chosen = policy.act(std::span<const typename P::State>(at));
      work.lookups += at.size() * policy.forest().trees();
    }
    work.steps += at.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < live.size(); ++i) {
      const Step<typename P::State> step = problem.step(at[i], chosen[i], rng);
      total[live[i]] += weight * step.reward;
      if (step.terminal) continue;
      live[kept] = live[i];
      at[kept++] = step.next;
    }
    live.resize(kept);
    at.resize(kept);
    weight *= options.discount;
  }
  const std::vector<float> rows = feature_rows(problem, std::span<const typename P::State>(at));
  std::vector<double> rest(at.size());
  value.predict(rows.data(), at.size(), rest.data());
  work.lookups += at.size() * value.trees();
  for (std::size_t i = 0; i < live.size(); ++i) total[live[i]] += weight * rest[i];
  for (std::size_t s = 0; s < states.size(); ++s) {
    double mean = 0;
    for (std::size_t r = 0; r < runs; ++r) mean += total[s * runs + r];
    mean /= static_cast<double>(runs);
    values[s] += options.backup_weight * (mean - values[s]);
  }
}

/// The state of affairs after one more iteration over `count` states. Incomplete if `stop` was requested.
template <Problem P, Executor E>
RfpiState<P> improve_by_backup(const P& problem, const RfpiOptions& given, const RfpiState<P>& before,
                               std::size_t count, std::span<const typename P::State> seed_states, const E& executor,
                               const Rng& rng, std::uint64_t evaluation_seed, std::stop_token stop) {
  RfpiOptions options = given;
  options.backup_steps = backup_steps_for(before.length, options);
  if (before.follows) options.lookahead.follow = followed;
  RfpiState<P> after;
  after.work = before.work;
  StateSamples<P>& samples = after.samples;
  samples.states =
      choose_states(problem, options, before, count, seed_states, executor, rng.stream(0), after.work, stop);
  samples.values.resize(samples.size());
  samples.actions.resize(samples.size());
  const bool initial = before.iteration < options.initial_iterations;
  const ForestPolicy<P> policy(problem, before.policy, options.agreement);
  if (options.adapt) {
    const auto states = std::span<const typename P::State>(samples.states);
    options.lookahead.hold = initial ? std::max(initial_hold, options.lookahead.hold)
                                     : chosen_hold(problem, before.value, states, options, rng.stream(5), after.work);
  }
  sort_by_leaves(problem, before.value.forest, samples.states);
  after.work.lookups += samples.size() * before.value.trees();
  constexpr std::size_t states_per_job = 16;
  const std::size_t jobs = (samples.size() + states_per_job - 1) / states_per_job;
  std::vector<RfpiWork> done(jobs);
  const bool complete = fill(
      executor, jobs,
      [&](std::size_t job) {
        const std::size_t begin = job * states_per_job;
        const std::size_t size = std::min(samples.size(), begin + states_per_job) - begin;
        const auto states = std::span<const typename P::State>(samples.states).subspan(begin, size);
        const auto actions = std::span(samples.actions).subspan(begin, size);
        const auto values = std::span(samples.values).subspan(begin, size);
        const Rng noise = rng.stream(1, job);
        const auto incumbents = initial ? std::vector<typename P::Action>() : policy.act(states);
        Lookahead<P> look(problem, before.value, options.discount, options.lookahead, initial ? nullptr : &policy);
        for (std::size_t i = 0; i < size; ++i) {
          const auto found = look(states[i], initial ? nullptr : &incumbents[i], noise.stream(i));
          actions[i] = found.action;
          values[i] = found.value;
        }
        done[job].steps = size * look.transitions();
        done[job].lookups = size * look.values() * before.value.trees() +
                            (incumbents.size() + size * look.policy_actions()) * before.policy.trees();
        if (!initial && options.backup_weight > 0) {
          backup_values(problem, options, policy, before.value, states, std::span<const typename P::Action>(actions),
                        values, noise.stream(size), done[job]);
        }
      },
      stop, Results<typename P::Action>{samples.actions, states_per_job},
      Results<double>{samples.values, states_per_job}, Results<RfpiWork>{done});
  if (!complete) return after;
  for (const RfpiWork& part : done) {
    after.work.steps += part.steps;
    after.work.lookups += part.lookups;
  }
  after.iteration = before.iteration + 1;
  if (options.reuse_previous_samples && before.iteration >= options.fixed_size_iterations)
    after.previous = before.samples;
  after.value = fit_value<LinearLeaf>(problem, samples, after.previous, options.value_forest, executor, rng.stream(2),
                                      after.work, stop);
  PolicyCost cost = learn_policy(problem, options, before, after, executor, rng.stream(3), evaluation_seed, stop);
  after.follows = before.follows;
  if (options.try_following && !initial && before.iteration % trial_every == 0) {
    cost = try_other_way(problem, options, before, after, policy, cost, executor, rng.stream(6), evaluation_seed, stop);
  }
  after.cost = cost.cost.mean;
  after.length = cost.length;
  after.transient = cost.transient;
  return after;
}

}  // namespace surefoot::detail
