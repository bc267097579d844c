// A forest on residuals: learned along simulated motion, taken off outputs, kept only if it helps on what it has not
// seen.
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::SlidingBlock;

/// Blocks pushed to and fro, whose measured place is off by a wave of the true place, and noise.
std::vector<Recording> block_recordings(double wave, double noise, int count = 8) {
  std::vector<Recording> recordings;
  for (int r = 0; r < count; ++r) {
    Recording recording = toys::blank_recording(SlidingBlock{}.info(), 300, 0.02);
    recording.name = "block " + std::to_string(r);
    recording.constants["load"] = r % 2;
    for (Eigen::Index i = 0; i < 300; ++i) recording.inputs(0, i) = 3 * std::cos((1.5 + 0.2 * r) * recording.time[i]);
    recording.outputs = simulate_augmented(SlidingBlock{}, {}, recording).outputs;
    Rng rng(3, static_cast<std::uint64_t>(r));
    for (Eigen::Index i = 1; i < 300; ++i) {
      recording.outputs(0, i) += wave * (1 + recording.constants["load"]) * std::sin(6 * recording.outputs(0, i));
      for (Eigen::Index k = 0; k < 2; ++k) recording.outputs(k, i) += noise * rng.normal();
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

struct Bench {
  BoundSimulator bound;
  std::vector<std::size_t> all;
  std::vector<SimulatedRun> runs;
  Weighting weighting;
  std::vector<std::vector<std::size_t>> folds;
};
Bench bench(std::vector<Recording> recordings) {
  Bench b{bind_simulator(SlidingBlock{}, std::move(recordings)), {}, {}, {}, {{0, 1}, {2, 3}, {4, 5}, {6, 7}}};
  b.all.resize(b.bound.recordings.size());
  std::iota(b.all.begin(), b.all.end(), std::size_t{0});
  b.runs = simulate_all(b.bound, nominal_hypothesis(b.bound), b.all, b.bound.integration, serially());
  b.weighting.sigma = residual_sizes(b.bound, b.all, b.runs);
  return b;
}

double error(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run) {
  return recording_error(bound, r, run, Eigen::VectorXd::Ones(2));
}

TEST_CASE("it learns what depends on the motion, and takes it off recordings it has not seen") {
  const Bench b = bench(block_recordings(0.05, 0.002));
  const std::vector<std::size_t> some(b.all.begin(), b.all.end() - 1);
  const std::vector<SimulatedRun> some_runs(b.runs.begin(), b.runs.end() - 1);
  const ResidualModel model = train_residual_model(b.bound, some, some_runs, serially(), 1);
  CHECK(model.outputs == std::vector<std::string>{"x_m", "v_mps"});
  CHECK(model.features == feature_names(b.bound, InputsOf::row_before));
  CHECK(error(b.bound, 7, corrected(b.bound, 7, b.runs[7], model)) < 0.5 * error(b.bound, 7, b.runs[7]));
  CHECK(corrected(b.bound, 7, b.runs[7], model).states == b.runs[7].states);
  const Comparison unseen = cross_validate_residual(b.bound, b.all, b.runs, b.folds, b.weighting, serially(), 1);
  CHECK(unseen.gain > 0.1);
  CHECK(unseen.t > 2.5);
}

TEST_CASE("on noise alone it gains nothing") {
  const Bench b = bench(block_recordings(0, 0.01));
  const Comparison unseen = cross_validate_residual(b.bound, b.all, b.runs, b.folds, b.weighting, serially(), 1);
  CHECK(unseen.gain < 0.01);
}

TEST_CASE("inputs that a controller makes from its readings do not tell their noise") {
  std::vector<Recording> recordings = block_recordings(0, 0.01);
  for (Recording& recording : recordings) {
    const Eigen::MatrixXd exact = simulate_augmented(SlidingBlock{}, {}, recording).outputs;
    const Eigen::MatrixXd noise = recording.outputs - exact;
    recording.inputs.row(0) += 50 * noise.row(0);  // moves the block by far less than the noise
    recording.outputs = simulate_augmented(SlidingBlock{}, {}, recording).outputs + noise;
  }
  const Bench b = bench(std::move(recordings));
  const std::vector<std::size_t> some(b.all.begin(), b.all.end() - 1);
  const std::vector<SimulatedRun> some_runs(b.runs.begin(), b.runs.end() - 1);
  const ResidualModel model = train_residual_model(b.bound, some, some_runs, serially(), 1);
  CHECK(error(b.bound, 7, corrected(b.bound, 7, b.runs[7], model)) > 0.95 * error(b.bound, 7, b.runs[7]));
}

TEST_CASE("rows without a measurement teach nothing") {
  auto recordings = block_recordings(0.05, 0.002);
  for (Recording& recording : recordings) {
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      if (i % 5 != 0) recording.outputs.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  const Bench b = bench(recordings);
  const ResidualModel model = train_residual_model(b.bound, b.all, b.runs, serially(), 1);
  CHECK(error(b.bound, 7, corrected(b.bound, 7, b.runs[7], model)) < 0.5 * error(b.bound, 7, b.runs[7]));
}

TEST_CASE("a model corrects a recording by itself; what it asks for must be there") {
  const Bench b = bench(block_recordings(0.05, 0.002));
  const ResidualModel model = train_residual_model(b.bound, b.all, b.runs, serially(), 1);
  Recording alone = b.bound.recordings[3];
  const BoundSimulator bound = bind_simulator(SlidingBlock{}, {alone});  // "load" no longer differs between recordings
  const SimulatedRun run = simulate_augmented(SlidingBlock{}, {}, alone);
  CHECK(corrected(bound, 0, run, model).outputs.isApprox(corrected(b.bound, 3, b.runs[3], model).outputs, 1e-9));
  alone.constants.clear();
  CHECK_THROWS_WITH_AS(corrected(bind_simulator(SlidingBlock{}, {alone}), 0, run, model),
                       "block 3: the residual model asks for 'load', which neither the simulator nor the recording has",
                       DiagnoseError);
  ResidualModel of_one_output = model;
  of_one_output.outputs.pop_back();
  CHECK_THROWS_WITH_AS(corrected(b.bound, 3, b.runs[3], of_one_output),
                       "the residual model has 1 outputs, the simulator has 2", DiagnoseError);
}

}  // namespace
}  // namespace surefoot::diagnosis
