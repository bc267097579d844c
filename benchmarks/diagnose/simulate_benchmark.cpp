// Simulations of recordings per second, what fits spend their time on: equations in C++ against the same equations read
// from a model file, without effects and with one. One simulation is one recording.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

#include "benchmarks/diagnose/servo.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#ifdef SUREFOOT_HAS_MODEL_FILES
#include "apps/diagnose/equations.hpp"

using namespace surefoot::diagnosis;
#endif

namespace {

using surefoot::Hypothesis;
using surefoot::BoundSimulator;

Hypothesis with_effect(const BoundSimulator& bound, const std::string& effect) {
  Hypothesis hypothesis = surefoot::nominal_hypothesis(bound);
  for (const surefoot::NamedEffect& named : diagnose_benchmarks::left_out(effect)) {
    hypothesis.effects.push_back(surefoot::attach(bound.info, named, surefoot::all_effects()));
    hypothesis.values.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(named.values.data(), static_cast<Eigen::Index>(named.values.size())));
  }
  return hypothesis;
}

void simulate_all(const BoundSimulator& bound, const Hypothesis& hypothesis) {
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    benchmark::DoNotOptimize(surefoot::simulate(bound, hypothesis, r, bound.integration));
  }
}

template <surefoot::Simulator S>
void simulations(benchmark::State& state, const S& simulator, const std::string& effect) {
  const BoundSimulator bound = surefoot::bind_simulator(simulator, diagnose_benchmarks::servo_recordings("", 1));
  const Hypothesis hypothesis = with_effect(bound, effect);
  for (auto _ : state) simulate_all(bound, hypothesis);
  using benchmark::Counter;
  const auto recordings = static_cast<double>(bound.recordings.size());
  state.counters["simulations"] = Counter(recordings, Counter::kIsIterationInvariantRate);
  state.counters["time_per_row"] = Counter(diagnose_benchmarks::row_count(bound.recordings),
                                           Counter::kIsIterationInvariantRate | Counter::kInvert);  // [s]
}

const toys::ServoPendulum native;
BENCHMARK_CAPTURE(simulations, native, native, "");
BENCHMARK_CAPTURE(simulations, native_coulomb_friction, native, "coulomb_friction");
BENCHMARK_CAPTURE(simulations, native_input_delay, native, "input_delay");

#ifdef SUREFOOT_HAS_MODEL_FILES
const diagnose_program::OdeModel& equations() {
  static const diagnose_program::OdeModel model(
      diagnose_program::parse_model_file(diagnose_benchmarks::servo_model_text, "servo.toml"));
  return model;
}
void simulations_of_equations(benchmark::State& state, const std::string& effect) {
  simulations(state, equations(), effect);
}
BENCHMARK_CAPTURE(simulations_of_equations, none, "");
BENCHMARK_CAPTURE(simulations_of_equations, coulomb_friction, "coulomb_friction");
BENCHMARK_CAPTURE(simulations_of_equations, input_delay, "input_delay");

// Both in turn, so that whatever else the computer does slows both down: how many times as long the equations take.
void equations_against_native(benchmark::State& state, const std::string& effect) {
  const auto recordings = diagnose_benchmarks::servo_recordings("", 1);
  const BoundSimulator compiled = surefoot::bind_simulator(native, recordings), read = surefoot::bind_simulator(equations(), recordings);
  const Hypothesis of_compiled = with_effect(compiled, effect), of_read = with_effect(read, effect);
  double compiled_time = 0, read_time = 0;
  for (auto _ : state) {
    compiled_time += diagnose_benchmarks::cpu_time([&] { simulate_all(compiled, of_compiled); });
    read_time += diagnose_benchmarks::cpu_time([&] { simulate_all(read, of_read); });
  }
  state.counters["ratio"] = read_time / compiled_time;
}
BENCHMARK_CAPTURE(equations_against_native, none, "");
BENCHMARK_CAPTURE(equations_against_native, coulomb_friction, "coulomb_friction");
BENCHMARK_CAPTURE(equations_against_native, input_delay, "input_delay");
#endif

}  // namespace
