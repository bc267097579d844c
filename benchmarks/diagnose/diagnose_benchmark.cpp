// Whole diagnoses of eight recordings of a servo pendulum whose model lacks dry friction: equations in C++ against the
// same equations read from a model file (`ratio`: how many times the CPU time), and how the cost grows with the rows
// recorded. `found`: 1 if dry friction was named first. Times are of the wall clock; CPU is that of all threads.
#include <benchmark/benchmark.h>

#include <vector>

#include "benchmarks/diagnose/servo.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#ifdef SUREFOOT_HAS_MODEL_FILES
#include "apps/diagnose/equations.hpp"
#endif

namespace {

template <surefoot::Simulator S>
double cpu_time(const S& simulator, const std::vector<surefoot::Recording>& recordings,
                surefoot::Diagnosis& diagnosis) {
  return diagnose_benchmarks::cpu_time(
      [&] { diagnosis = surefoot::diagnose(simulator, recordings, {}, surefoot::Threads{}, 1); });
}

double found(const surefoot::Diagnosis& diagnosis) {
  return !diagnosis.effects.empty() && diagnosis.effects.front().name == "coulomb_friction" ? 1 : 0;
}

// The argument: how many times as many rows as in eight recordings of 6 s at 200 Hz.
void native(benchmark::State& state) {
  const auto recordings = diagnose_benchmarks::servo_recordings("coulomb_friction", static_cast<int>(state.range(0)));
  surefoot::Diagnosis diagnosis;
  double cpu = 0;
  for (auto _ : state) cpu += cpu_time(toys::ServoPendulum{}, recordings, diagnosis);
  const double rows = diagnose_benchmarks::row_count(recordings);
  state.counters["rows"] = rows;
  state.counters["cpu_per_row"] = cpu / rows;  // [s]
  state.counters["found"] = found(diagnosis);
}
BENCHMARK(native)->Arg(1)->Arg(4)->Arg(16)->Arg(100)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(
    benchmark::kSecond);

#ifdef SUREFOOT_HAS_MODEL_FILES
void model_file_against_native(benchmark::State& state) {
  using namespace diagnose_program;
  const auto recordings = diagnose_benchmarks::servo_recordings("coulomb_friction", 1);
  const OdeModel model(parse_model_file(diagnose_benchmarks::servo_model_text, "servo.toml"));
  surefoot::Diagnosis of_native, of_model;
  double native_cpu = 0, model_cpu = 0;
  for (auto _ : state) {
    native_cpu += cpu_time(toys::ServoPendulum{}, recordings, of_native);
    model_cpu += cpu_time(model, recordings, of_model);
  }
  state.counters["native_cpu"] = native_cpu;     // [s]
  state.counters["model_file_cpu"] = model_cpu;  // [s]
  state.counters["ratio"] = model_cpu / native_cpu;
  state.counters["found"] = found(of_model);
}
BENCHMARK(model_file_against_native)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kSecond);
#endif

}  // namespace
