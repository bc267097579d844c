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
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/solve/lookahead.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "surefoot/solve/visited_states.hpp"
#include "tests/support/pendulum.hpp"

namespace {

using namespace surefoot;  // NOLINT(google-build-using-namespace): a program, not a header
using sigmaban::Approach;
using toy::Pendulum;

constexpr double discount = 0.98;

// A policy after a training of fifteen iterations, states that it visits, and a forest of about what they are worth to
// it.
template <Problem P>
struct Trained {
  using ValueForest = Forest<feature_dim<P>(), 1, LinearLeaf>;

  P problem;
  ForestPolicy<P> policy;
  std::vector<typename P::State> states;
  ValueForest value;

  explicit Trained(const P& p)
      : problem(p), policy(rfpi(p, {.budget = {.counted_seconds = 5}, .horizon = P::horizon}, Threads{}, 1).policy) {
    states = visited_states(
        problem, [&](auto some) { return policy.act(some); }, 20'000 / P::horizon, P::horizon, 0.3, Threads{}, Rng(2));
    Dataset<feature_dim<P>(), 1> samples;
    const auto count = static_cast<Eigen::Index>(states.size());
    samples.inputs.resize(feature_dim<P>(), count);
    samples.outputs.resize(1, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& at = states[static_cast<std::size_t>(i)];
      samples.inputs.col(i) = features(problem, at).template cast<float>();
      samples.outputs(0, i) =
          run_return(problem, policy, at, P::horizon, discount, Rng(3, static_cast<std::uint64_t>(i)));
    }
    value = train_extra_trees<LinearLeaf>(samples, RfpiOptions().value_forest, Threads{}, 1);
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
  Lookahead<P> look(t.problem, t.value, discount, options);
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
