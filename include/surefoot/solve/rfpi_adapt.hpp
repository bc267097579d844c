// Adaptation of RFPI to a problem: whether its simulator has noise, and how large a policy is best.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_options.hpp"

namespace surefoot::detail {

/// Whether transitions were the same for two streams of random numbers, over random runs and states of the whole state
/// box: then one sample tells as much as many.
template <Problem P>
bool is_deterministic(const P& problem, int horizon, const Rng& rng) {
  constexpr std::size_t looked_at = 1000;  // states: noise in one of 200 is missed once in 150 times
  const Box<P::action_dim> actions = problem.action_box();
  const Box<P::state_dim> states = problem.state_box();
  typename P::State state = states.center();
  int left = 0;  // transitions of this run
  for (std::size_t i = 0; i < looked_at; ++i) {
    Rng first = rng.stream(i, 0), second = rng.stream(i, 1), choice = rng.stream(i, 2);
    const bool in_run = i % 2 == 0;
    if (in_run && left == 0) {
      state = problem.initial_state(choice);
      left = horizon;
    }
    const typename P::State from = in_run ? state : typename P::State(states.sample(choice));
    const typename P::Action action = actions.sample(choice);
    const auto a = problem.step(from, action, first), b = problem.step(from, action, second);
    if ((a.next.array() != b.next.array()).any() || a.reward != b.reward || a.terminal != b.terminal) return false;
    if (!in_run) continue;
    state = a.next;
    left = a.terminal ? 0 : left - 1;
  }
  return true;
}

/// Steps of backups without noise: information comes from so many transitions away in an iteration.
constexpr int least_backup_steps = 6;

/// The options with what a simulator without noise allows: single samples, and so values of longer runs of the policy,
/// and more iterations. Values are then as exact as the forest before, and it pays to split where affine leaves do not
/// fit, not where values differ most. Short runs are replaced; with noise (the ball approach) that gained nothing.
/// Whether lookaheads follow the policy is tried; with noise they would need many samples of it.
inline RfpiOptions without_noise(RfpiOptions options) {
  constexpr double growth = 1.1;  // iterations are cheap, and values need many where runs are long
  options.lookahead.samples = options.lookahead.refined_samples = options.backup_runs = 1;
  options.backup_steps = std::max(options.backup_steps, least_backup_steps);
  options.replace_short_runs = true;
  options.try_following = options.lookahead.follow == 0;
  options.backup_weight = 1;
  options.value_forest.model_score = true;
  options.growth = std::min(options.growth, growth);
  return options;
}

/// Steps of backups where runs last `length` transitions on average. Where backups alone give the values, a run has no
/// more than ten of them, however finely the simulator steps: each adds the errors of a value forest. Runs, not the
/// horizon, which they may end long before: steps past what is left of a run make its value what the policy is worth
/// and not what the best actions are.
inline int backup_steps_for(double length, const RfpiOptions& options) {
  constexpr int backups_of_a_run = 10;
  if (!options.adapt || options.backup_weight < 1) return options.backup_steps;
  return std::max(options.backup_steps, static_cast<int>(length / backups_of_a_run));
}

/// Runs that tell how good a policy is.
inline int evaluation_runs(const RfpiOptions& options) {
  constexpr int transitions = 50'000, least = 200;
  return options.evaluation_runs > 0 ? options.evaluation_runs : std::max(least, transitions / options.horizon);
}

/// Minus the returns of a policy.
struct PolicyCost {
  Estimate cost;          // as they are
  double discounted = 0;  // mean of the discounted ones, which is what the values are about
  double length = 0;      // mean length of the runs [transitions]
  int transient = 0;      // see transient_of()
  std::vector<double> runs;  // the discounted ones, run by run
};

/// Whether a policy does better than another one on the same runs, by more than chance explains: the mean difference of
/// their discounted costs is more than its standard error.
inline bool does_better(const PolicyCost& one, const PolicyCost& other) {
  std::vector<double> differences = other.runs;
  for (std::size_t i = 0; i < differences.size(); ++i) differences[i] -= one.runs[i];
  const Estimate by = estimate(differences);
  return by.mean > by.standard_error;
}

/// The number of transitions until runs have come to rest, or to whatever else goes on and on: those that bring most of
/// what mean costs differ from what they are at the end. `costs`: mean over the runs, transition after transition. All
/// of them where there is no such beginning.
inline int transient_of(std::span<const double> costs) {
  constexpr double most = 0.9;         // of the sum of those differences
  constexpr std::size_t end_part = 5;  // the last fifth of a run is its end
  const std::size_t last = std::max<std::size_t>(1, costs.size() / end_part);
  double end = 0;
  for (const double cost : costs.last(last)) end += cost;
  end /= static_cast<double>(last);
  double all = 0;
  for (const double cost : costs) all += std::abs(cost - end);
  double sum = 0;
  for (std::size_t t = 0; t < costs.size(); ++t) {
    sum += std::abs(costs[t] - end);
    if (sum >= most * all && all > 0) return static_cast<int>(t) + 1;
  }
  return static_cast<int>(costs.size());
}

/// Over runs that are the same for every policy; in lockstep, so that a forest sees many states at once.
template <Problem P, Executor E>
PolicyCost policy_cost(const P& problem, const typename ForestPolicy<P>::ActionForest& forest,
                       const RfpiOptions& options, int runs, const E& executor, std::uint64_t seed) {
  using State = typename P::State;
  constexpr std::size_t runs_per_job = 64;
  const ForestPolicy<P> policy(problem, forest, options.agreement);
  const auto count = static_cast<std::size_t>(runs);
  const std::size_t jobs = (count + runs_per_job - 1) / runs_per_job;
  const auto horizon = static_cast<std::size_t>(options.horizon);
  std::vector<double> plain(count, 0.0), discounted(count, 0.0), length(count, 0.0);
  std::vector<double> by_time(jobs * horizon, 0.0);  // costs of the runs of a job, transition after transition
  const auto job = [&](std::size_t chunk) {
    std::vector<std::size_t> live;
    std::vector<State> states;
    for (std::size_t i = chunk * runs_per_job; i < std::min(count, (chunk + 1) * runs_per_job); ++i) {
      Rng start = Rng(seed, i).stream(0);
      live.push_back(i);
      states.push_back(problem.initial_state(start));
    }
    double weight = 1;
    for (int t = 0; t < options.horizon && !live.empty(); ++t, weight *= options.discount) {
      const auto actions = policy.act(states);
      std::size_t kept = 0;
      for (std::size_t k = 0; k < live.size(); ++k) {
        Rng noise = Rng(seed, live[k]).stream(1).stream(static_cast<std::uint64_t>(t));
        const Step<State> step = problem.step(states[k], actions[k], noise);
        plain[live[k]] -= step.reward;
        by_time[chunk * horizon + static_cast<std::size_t>(t)] -= step.reward;
        length[live[k]] += 1;
        discounted[live[k]] -= weight * step.reward;
        if (step.terminal) continue;
        live[kept] = live[k];
        states[kept++] = step.next;
      }
      live.resize(kept);
      states.resize(kept);
    }
  };
  fill(executor, jobs, job, {}, Results<double>{plain, runs_per_job}, Results<double>{discounted, runs_per_job},
       Results<double>{length, runs_per_job}, Results<double>{by_time, horizon});
  for (std::size_t i = horizon; i < by_time.size(); ++i) by_time[i % horizon] += by_time[i];
  by_time.resize(horizon);
  for (double& cost : by_time) cost /= static_cast<double>(count);
  return {estimate(plain), estimate(discounted).mean, estimate(length).mean, transient_of(by_time),
          std::move(discounted)};
}

/// The other size of policy, in leaves per tree, that an iteration tries: three times smaller and larger in turn,
/// within [1, most].
inline int other_size(int leaves, int most, int iteration) {
  constexpr int factor = 3;
  const bool can_grow = leaves<most, can_shrink = leaves> 1;
  const bool grow = can_grow && (!can_shrink || iteration % 2 == 0);
  return grow ? std::min(most, factor * leaves) : can_shrink ? std::max(1, leaves / factor) : leaves;
}

}  // namespace surefoot::detail
