// Simulations of recordings per second, what fits spend their time on: equations in C++ against the same equations read
// from a model file, without effects and with one. One simulation is one recording.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "benchmarks/diagnose/servo.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#ifdef SUREFOOT_HAS_MODEL_FILES
#include "apps/diagnose/equations.hpp"
#endif

namespace {

using surefoot::Recording;

/// Nominal parameters and one effect, or none without a name.
template <surefoot::Simulator S>
void simulate_all(const S& simulator, const std::vector<Recording>& recordings, const std::string& effect) {
  static const std::vector<surefoot::Effect> effects = surefoot::all_effects();
  const surefoot::Augmented augmented{.effects = diagnose_benchmarks::left_out(effect)};
  for (const Recording& recording : recordings) {
    benchmark::DoNotOptimize(simulate_augmented(simulator, augmented, recording, effects));
  }
}

template <surefoot::Simulator S>
void simulations(benchmark::State& state, const S& simulator, const std::string& effect) {
  const auto recordings = diagnose_benchmarks::servo_recordings("", 1);
  for (auto _ : state) simulate_all(simulator, recordings, effect);
  using benchmark::Counter;
  state.counters["simulations"] = Counter(static_cast<double>(recordings.size()), Counter::kIsIterationInvariantRate);
  state.counters["time_per_row"] = Counter(diagnose_benchmarks::row_count(recordings),
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
  double compiled_time = 0, read_time = 0;
  for (auto _ : state) {
    compiled_time += diagnose_benchmarks::cpu_time([&] { simulate_all(native, recordings, effect); });
    read_time += diagnose_benchmarks::cpu_time([&] { simulate_all(equations(), recordings, effect); });
  }
  state.counters["ratio"] = read_time / compiled_time;
}
BENCHMARK_CAPTURE(equations_against_native, none, "");
BENCHMARK_CAPTURE(equations_against_native, coulomb_friction, "coulomb_friction");
BENCHMARK_CAPTURE(equations_against_native, input_delay, "input_delay");
#endif

}  // namespace
