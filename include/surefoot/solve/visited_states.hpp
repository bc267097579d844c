// The states that runs of a policy visit: where a regression has to be good.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/solve/forest_policy.hpp"

namespace surefoot {

/// Actions for many states: a policy's, or random ones.
template <Problem P>
using ActOnBatch = std::function<std::vector<typename P::Action>(std::span<const typename P::State>)>;

/// Where runs end that visit states: at their horizon or a terminal step, or also where they leave the state box and
/// are further out than they started.
enum class RunEnd { horizon, state_box };

namespace detail {

/// How far a state is outside the box, in the dimension where it is furthest [half widths from the centre]; 1 inside.
template <int N>
double half_widths_out(const Box<N>& box, const Vec<N>& state) {
  double most = 1;
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const double low = box.low()[i], high = box.high()[i];
    const bool inside = state[i] >= low && state[i] <= high;  // exactly: many problems keep states on the bounds
    if (!inside && high > low) most = std::max(most, std::abs(2 * state[i] - low - high) / (high - low));
  }
  return most;
}

}  // namespace detail

/// Starts `runs` runs at the problem's initial states and returns every state in which an action was taken, run by run.
/// With chance `exploration` per step a random action is held for 1 to 3 steps instead of the policy's.
/// `act` maps the states of up to 32 runs to their actions, for different runs from several threads at once.
/// `end`: see RunEnd. Run i draws from rng.stream(i). Fewer runs come back if `stop` is requested.
template <Problem P, Executor E>
std::vector<typename P::State> visited_states(const P& problem, const std::type_identity_t<ActOnBatch<P>>& act,
                                              std::size_t runs, int horizon, double exploration, const E& executor,
                                              const Rng& rng, std::stop_token stop = {}, RunEnd end = RunEnd::horizon) {
  using State = typename P::State;
  using Action = typename P::Action;
  constexpr std::size_t runs_per_job = 32;  // in lockstep, so that a forest sees a batch
  const std::size_t jobs = (runs + runs_per_job - 1) / runs_per_job;
  std::vector<std::vector<State>> visited(jobs);
  const Box<P::action_dim> box = problem.action_box();
  const Box<P::state_dim> normal = problem.state_box();
  fill(
      executor, jobs,
      [&](std::size_t job) {
        struct Run {
          std::size_t index;
          Rng rng;
          int held_steps = 0;
          Action held = Action::Zero();
          double reach = 1;  // half_widths_out() of its start
        };
        std::vector<Run> live;
        std::vector<State> states;
        for (std::size_t i = job * runs_per_job; i < std::min(runs, (job + 1) * runs_per_job); ++i) {
          live.push_back({i, rng.stream(i)});
          states.push_back(problem.initial_state(live.back().rng));
          live.back().reach = detail::half_widths_out<P::state_dim>(normal, states.back());
        }
        std::vector<std::vector<State>> paths(live.size());
        for (int t = 0; t < horizon && !live.empty(); ++t) {
          std::vector<Action> actions = act(std::span<const State>(states));
          std::size_t kept = 0;
          for (std::size_t i = 0; i < live.size(); ++i) {
            Run& run = live[i];
            paths[run.index % runs_per_job].push_back(states[i]);
            if (exploration > 0) {
              if (run.held_steps == 0 && run.rng.uniform() < exploration) {
                run.held_steps = 1 + static_cast<int>(run.rng.below(3));
                run.held = box.sample(run.rng);
              }
              if (run.held_steps > 0) {
                --run.held_steps;
                actions[i] = run.held;
              }
            }
            const Step<State> step = problem.step(states[i], actions[i], run.rng);
            if (step.terminal) continue;
            if (end == RunEnd::state_box && detail::half_widths_out<P::state_dim>(normal, step.next) > run.reach)
              continue;
            live[kept] = run;
            states[kept++] = step.next;
          }
          live.resize(kept, Run{0, rng});
          states.resize(kept);
        }
        for (const auto& path : paths) visited[job].insert(visited[job].end(), path.begin(), path.end());
      },
      std::move(stop), Results<std::vector<State>>{visited});
  std::vector<State> all;
  for (const auto& part : visited) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// At least `count` states, from as many runs as that takes: where runs end early, as at a goal, more of them. First as
/// many as whole runs would need, then by the mean length of those so far. Fewer come back if `stop` is requested.
template <Problem P, Executor E>
std::vector<typename P::State> enough_visited_states(const P& problem, const std::type_identity_t<ActOnBatch<P>>& act,
                                                     std::size_t count, int horizon, double exploration,
                                                     const E& executor, const Rng& rng, std::stop_token stop = {},
                                                     RunEnd end = RunEnd::horizon) {
  std::size_t runs = count / static_cast<std::size_t>(horizon) + 1;
  auto all = visited_states(problem, act, runs, horizon, exploration, executor, rng, stop, end);
  for (std::uint64_t round = 1; !all.empty() && all.size() < count; ++round) {
    const std::size_t more = (count - all.size()) * runs / all.size() + 1;
    const auto next =
        visited_states(problem, act, more, horizon, exploration, executor, rng.stream(round, 0), stop, end);
    if (next.empty()) break;  // stopped
    all.insert(all.end(), next.begin(), next.end());
    runs += more;
  }
  return all;
}

}  // namespace surefoot
