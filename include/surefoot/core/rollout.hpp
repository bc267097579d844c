// Runs of a policy in a problem: one trajectory, the value of a policy by Monte Carlo, and two policies compared on
// common random numbers (the same starts and the same noise for both, so that their difference has little variance).
// Cost: runs * horizon steps of the problem and as many calls of the policy.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <stop_token>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/error.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {

struct RolloutOptions {
  int runs = 10'000;
  int horizon = 50;       // [transitions], the longest a run gets; a terminal step ends it earlier
  double discount = 1.0;  // per transition
};

/// A mean over independent runs and how well it is known.
struct Estimate {
  double mean = 0;
  double standard_error = 0;  // of the mean; infinite for a single run
  std::size_t runs = 0;

  // The 95 % interval of the mean (normal approximation, good from about 30 runs).
  double half_width() const { return 1.96 * standard_error; }
  double low() const { return mean - half_width(); }
  double high() const { return mean + half_width(); }
};

/// The mean of independent samples, summed in their order.
inline Estimate estimate(std::span<const double> samples) {
  if (samples.empty()) throw CoreError("estimate: needs at least one sample");
  const double count = static_cast<double>(samples.size());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
  double squares = 0;
  for (const double sample : samples) squares += (sample - mean) * (sample - mean);
  const double error =
      samples.size() > 1 ? std::sqrt(squares / (count - 1) / count) : std::numeric_limits<double>::infinity();
  return {mean, error, samples.size()};
}

/// Runs `policy` from `state` and calls visit(state, action, step) after each transition. A policy with memory starts
/// afresh. The noise of transition t comes from rng.stream(t), whatever happened before: runs of different policies
/// with equal rng meet the same noise.
template <Problem P, Policy<P> F, class Visit>
void run(const P& problem, const F& policy, typename P::State state, int horizon, const Rng& rng, Visit&& visit) {
  auto&& acting = start_of_run<P>(policy, rng);
  for (int t = 0; t < horizon; ++t) {
    const typename P::Action action = acting(state);
    Rng noise = rng.stream(static_cast<std::uint64_t>(t));
    const Step<typename P::State> step = problem.step(state, action, noise);
    visit(state, action, step);
    if (step.terminal) return;
    state = step.next;
  }
}

/// Sum of the discounted rewards of one run from `state`; the random numbers are those of `run`.
template <Problem P, Policy<P> F>
double run_return(const P& problem, const F& policy, const typename P::State& state, int horizon, double discount,
                  const Rng& rng) {
  double sum = 0;
  double weight = 1;
  run(problem, policy, state, horizon, rng, [&](const auto&, const auto&, const auto& step) {
    sum += weight * step.reward;
    weight *= discount;
  });
  return sum;
}

/// Everything that happened in one run.
template <Problem P>
struct Trajectory {
  std::vector<typename P::State> states;    // one more than actions: the first is the start
  std::vector<typename P::Action> actions;  // as the policy gave them
  std::vector<double> rewards;
  bool terminal = false;  // whether a terminal step ended it
};

/// One run in full; the random numbers are those of `run`.
template <Problem P, Policy<P> F>
Trajectory<P> trajectory(const P& problem, const F& policy, const typename P::State& start, int horizon,
                         const Rng& rng) {
  Trajectory<P> result;
  result.states.push_back(start);
  run(problem, policy, start, horizon, rng, [&](const auto&, const auto& action, const auto& step) {
    result.actions.push_back(action);
    result.rewards.push_back(step.reward);
    result.states.push_back(step.next);
    result.terminal = step.terminal;
  });
  return result;
}

/// The return of every run, in order. Run i draws from Rng(seed, i): its start from stream 0, its transitions from
/// stream 1. So the same seed means the same starts and noise for every policy, and the result is the same for every
/// executor. Throws CoreError if `stop` is requested before the end.
template <Problem P, Policy<P> F, Executor E>
std::vector<double> returns(const P& problem, const F& policy, const RolloutOptions& options, const E& executor,
                            std::uint64_t seed, std::stop_token stop = {}) {
  if (options.runs < 1) throw CoreError("RolloutOptions: runs must be at least 1, got " + std::to_string(options.runs));
  if (options.horizon < 1) {
    throw CoreError("RolloutOptions: horizon must be at least 1, got " + std::to_string(options.horizon));
  }
  if (!(options.discount > 0 && options.discount <= 1)) {
    throw CoreError("RolloutOptions: discount must be in (0, 1], got " + std::to_string(options.discount));
  }
  constexpr std::size_t runs_per_job = 64;  // so that a job outweighs the cost of handing it out
  const auto runs = static_cast<std::size_t>(options.runs);
  std::vector<double> result(runs);
  const auto job = [&](std::size_t chunk) {
    const std::size_t end = std::min(runs, (chunk + 1) * runs_per_job);
    for (std::size_t i = chunk * runs_per_job; i < end; ++i) {
      const Rng rng(seed, i);
      Rng start = rng.stream(0);
      result[i] =
          run_return(problem, policy, problem.initial_state(start), options.horizon, options.discount, rng.stream(1));
    }
  };
  const Results<double> returns{result, runs_per_job};
  if (!fill(executor, (runs + runs_per_job - 1) / runs_per_job, job, std::move(stop), returns)) {
    throw CoreError("stopped before all runs were done");
  }
  return result;
}

/// The value of a policy: its mean return from the problem's own initial states.
template <Problem P, Policy<P> F, Executor E>
Estimate evaluate(const P& problem, const F& policy, const RolloutOptions& options, const E& executor,
                  std::uint64_t seed, std::stop_token stop = {}) {
  return estimate(returns(problem, policy, options, executor, seed, std::move(stop)));
}

/// By how much the return of `a` exceeds that of `b` on common random numbers, with the interval of the difference.
template <Problem P, Policy<P> A, Policy<P> B, Executor E>
Estimate compare(const P& problem, const A& a, const B& b, const RolloutOptions& options, const E& executor,
                 std::uint64_t seed, std::stop_token stop = {}) {
  std::vector<double> difference = returns(problem, a, options, executor, seed, stop);
  const std::vector<double> other = returns(problem, b, options, executor, seed, stop);
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= other[i];
  return estimate(difference);
}

// What a type that is no Problem, or no Policy of it, gets: one short error that names the member it lacks.

template <class P, class F>
  requires(!Policy<F, P>)
auto evaluate(const P&, const F&, const RolloutOptions&, auto&&...) {
  if constexpr (!Problem<P>) {
    return explain_problem<P>();
  } else {
    return explain_policy<F, P>();
  }
}

template <class P, class A, class B>
  requires(!Policy<A, P> || !Policy<B, P>)
auto compare(const P&, const A&, const B&, const RolloutOptions&, auto&&...) {
  if constexpr (!Problem<P>) {
    return explain_problem<P>();
  } else {
    return explain_policy<std::conditional_t<Policy<A, P>, B, A>, P>();
  }
}

}  // namespace surefoot
