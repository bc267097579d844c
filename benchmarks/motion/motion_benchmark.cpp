// What a calibration costs: 25 sequences of 25 cycles with final poses, and one of the curve's 200 repetitions.
#include <benchmark/benchmark.h>

#include <span>

#include "surefoot/motion/plan.hpp"
#include "surefoot/motion/previous_command_correction.hpp"
#include "tests/support/walks.hpp"

namespace {

using surefoot::WalkSequence;

std::vector<WalkSequence> recorded() {
  return toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 25, 1));
}

template <surefoot::MotionModel M>
void predict(benchmark::State& state) {
  const auto walks = recorded();
  const M model;
  for (auto _ : state) {
    for (const WalkSequence& walk : walks) benchmark::DoNotOptimize(predict_final_pose(model, walk));
  }
  state.counters["cycles"] =
      benchmark::Counter(25.0 * 25.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(predict<surefoot::FullLinearCorrection>);

template <surefoot::MotionModel M>
void likelihood(benchmark::State& state) {
  const auto walks = recorded();
  const auto noise = toys::paper_noise().as_motion_noise();
  for (auto _ : state) benchmark::DoNotOptimize(surefoot::fit_model<M>(walks, noise));
}
BENCHMARK(likelihood<surefoot::ProportionalCorrection>)->Unit(benchmark::kMillisecond);
BENCHMARK(likelihood<surefoot::FullLinearCorrection>)->Unit(benchmark::kMillisecond);
BENCHMARK(likelihood<surefoot::PreviousCommandCorrection>)->Unit(benchmark::kMillisecond);

template <surefoot::MotionModel M>
void likelihood_with_noise(benchmark::State& state) {
  const auto walks = recorded();
  for (auto _ : state) benchmark::DoNotOptimize(surefoot::calibrate<M>(walks));
}
BENCHMARK(likelihood_with_noise<surefoot::FullLinearCorrection>)->Unit(benchmark::kMillisecond);

template <surefoot::MotionModel M>
void published(benchmark::State& state) {
  const auto walks = recorded();
  for (auto _ : state) benchmark::DoNotOptimize(surefoot::published_fit<M>(walks, {}, surefoot::Serial{}, 1));
}
BENCHMARK(published<surefoot::ProportionalCorrection>)->Unit(benchmark::kMillisecond);
BENCHMARK(published<surefoot::FullLinearCorrection>)->Unit(benchmark::kMillisecond);
BENCHMARK(published<surefoot::PreviousCommandCorrection>)->Unit(benchmark::kMillisecond);

}  // namespace
