// What RFPI is made of, and what it reaches with how much work: lookaheads, actions and runs of a forest policy, and
// the cost of the policy against counted seconds. `cpu` is what those seconds really took.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "examples/sigmaban/approach/approach.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/lookahead.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "tests/support/pendulum.hpp"

namespace {

using namespace surefoot;  // NOLINT(google-build-using-namespace): a program, not a header
using sigmaban::Approach;
using toy::Pendulum;

// States where a policy is used, and forests as large as those of a training of some seconds.
template <Problem P>
struct Trained {
  P problem;
  std::vector<typename P::State> states;
  ForestPolicy<P> policy;
  typename RfpiState<P>::LinearValue value;

  explicit Trained(const P& p) : problem(p), policy(p, {}) {
    const RfpiOptions options;
    RfpiState<P> state;
    for (int i = 0; i <= options.initial_iterations; ++i) {
      state = detail::improve_by_backup(problem, options, state, 20'000, {}, Threads{}, Rng(1, i), {});
    }
    states = state.samples.states;
    value = state.value;
    policy = ForestPolicy<P>(p, state.policy);
  }
};

const Trained<Pendulum>& trained(const Pendulum& problem) {
  static const Trained<Pendulum> instance(problem);
  return instance;
}
const Trained<Approach>& trained(const Approach& problem) {
  static const Trained<Approach> instance(problem);
  return instance;
}

template <Problem P>
void lookaheads(benchmark::State& state, const P& problem) {
  const auto& t = trained(problem);
  const LookaheadOptions options;
  Lookahead<P, typename RfpiState<P>::LinearValue> look(t.problem, t.value, 0.98, options);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& at = t.states[i % t.states.size()];
    benchmark::DoNotOptimize(look(at, nullptr, Rng(1, i++)));
  }
  state.counters["lookaheads"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["transitions"] =
      benchmark::Counter(static_cast<double>(look.transitions()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(lookaheads, pendulum, Pendulum{});
BENCHMARK_CAPTURE(lookaheads, approach, Approach::ha());

// One state after the other, as on the robot, with everything in the caches.
template <Problem P>
void policy_action(benchmark::State& state, const P& problem) {
  const auto& t = trained(problem);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(t.policy(t.states[i]));
    i = i + 1 < t.states.size() ? i + 1 : 0;
  }
  state.counters["leaves"] = static_cast<double>(t.policy.forest().leaves());
  state.counters["bytes"] = static_cast<double>(t.policy.forest().bytes());
}
BENCHMARK_CAPTURE(policy_action, pendulum, Pendulum{});
BENCHMARK_CAPTURE(policy_action, approach, Approach::ha());

template <Problem P, Executor E>
void policy_runs(benchmark::State& state, const P& problem, const E& executor) {
  const auto& t = trained(problem);
  const RolloutOptions options{.runs = 1000, .horizon = P::horizon};
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(t.problem, t.policy, options, executor, 1));
  state.counters["rollouts"] = benchmark::Counter(options.runs, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(policy_runs, pendulum_serial, Pendulum{}, Serial{})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(policy_runs, approach_serial, Approach::ha(), Serial{})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(policy_runs, approach_threads, Approach::ha(), Threads{})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// One training per counted time: how much is reached by when.
template <Problem P>
void learning(benchmark::State& state, const P& problem, std::initializer_list<int> budgets) {
  for (auto _ : state) {
    for (const int seconds : budgets) {
      RfpiOptions options;
      options.budget.counted_seconds = seconds;
      options.horizon = P::horizon;
      const auto result = rfpi(problem, options, Threads{}, 1);
      const std::string at = "_" + std::to_string(seconds) + "s";
      state.counters["cost" + at] = result.cost.mean;
      state.counters["cpu" + at] = result.history.back().cpu_seconds;
      state.counters["leaves" + at] = static_cast<double>(result.policy.forest().leaves());
    }
  }
}
BENCHMARK_CAPTURE(learning, pendulum, Pendulum{}, {1, 2, 4, 8})
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(learning, approach_ha, Approach::ha(), {5, 15, 45})
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(learning, approach_anha, Approach::anha(), {5, 15, 45})
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
