// Whole diagnoses of eight recordings of a servo pendulum whose model lacks dry friction: equations in C++ against the
// same equations read from a model file, and how the cost grows with the rows recorded. `found`: 1 if dry friction was
// named first. Times are of the wall clock; CPU is that of all threads.
#include <benchmark/benchmark.h>

#include <vector>

#include "benchmarks/diagnose/servo.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#ifdef SUREFOOT_HAS_MODEL_FILES
#include "examples/diagnose/equations.hpp"
#endif

namespace {

template <surefoot::Simulator S>
void diagnose(benchmark::State& state, const S& simulator) {
  const auto recordings = diagnose_benchmarks::servo_recordings("coulomb_friction", static_cast<int>(state.range(0)));
  surefoot::Diagnosis diagnosis;
  for (auto _ : state) diagnosis = surefoot::diagnose(simulator, recordings, {}, surefoot::Threads{}, 1);
  using benchmark::Counter;
  const double rows = diagnose_benchmarks::row_count(recordings);
  state.counters["rows"] = rows;
  state.counters["time_per_row"] = Counter(rows, Counter::kIsIterationInvariantRate | Counter::kInvert);  // [s]
  state.counters["found"] = !diagnosis.effects.empty() && diagnosis.effects.front().name == "coulomb_friction" ? 1 : 0;
}

// The argument: how many times as many rows as in eight recordings of 6 s at 200 Hz.
void native(benchmark::State& state) { diagnose(state, toys::ServoPendulum{}); }
BENCHMARK(native)->Arg(1)->Arg(4)->Arg(16)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(
    benchmark::kSecond);

#ifdef SUREFOOT_HAS_MODEL_FILES
void model_file(benchmark::State& state) {
  using namespace diagnose_program;
  diagnose(state, OdeModel(parse_model_file(diagnose_benchmarks::servo_model_text, "servo.toml")));
}
BENCHMARK(model_file)->Arg(1)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kSecond);
#endif

}  // namespace
