// Simulated transitions per second, with the cheapest of policies: what the problem, its noise and the bookkeeping
// cost.
#include <benchmark/benchmark.h>

#include "examples/sigmaban/approach/approach.hpp"
#include "surefoot/core/rollout.hpp"
#include "tests/support/pendulum.hpp"

namespace {

template <surefoot::Problem P, surefoot::Executor E>
void rollouts(benchmark::State& state, const P& problem, const E& executor) {
  const auto still = [](const typename P::State&) -> typename P::Action { return P::Action::Zero(); };
  const surefoot::RolloutOptions options{.runs = 2000, .horizon = 50};
  for (auto _ : state) benchmark::DoNotOptimize(surefoot::evaluate(problem, still, options, executor, 1));
  state.counters["transitions"] =
      benchmark::Counter(options.runs * options.horizon, benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(rollouts, pendulum_serial, surefoot::toy::Pendulum{}, surefoot::Serial{})->UseRealTime();
BENCHMARK_CAPTURE(rollouts, pendulum_threads, surefoot::toy::Pendulum{}, surefoot::Threads{})->UseRealTime();
BENCHMARK_CAPTURE(rollouts, approach_serial, sigmaban::Approach::ha(), surefoot::Serial{})->UseRealTime();
BENCHMARK_CAPTURE(rollouts, approach_threads, sigmaban::Approach::ha(), surefoot::Threads{})->UseRealTime();

// What it costs to hand out jobs that do nothing.
void empty_jobs(benchmark::State& state) {
  const surefoot::Threads threads;
  for (auto _ : state)
    threads.run(static_cast<std::size_t>(state.range(0)), [](std::size_t i) { benchmark::DoNotOptimize(i); });
}
BENCHMARK(empty_jobs)->Arg(2)->Arg(1000)->UseRealTime();

}  // namespace
