// Calibration as a stage: parameters, integration and sizes, and what recordings say of inputs.
#include "surefoot/diagnose/verdict/calibrate_model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/diagnose/verdict/recording_stage.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

EstimationSetup calibrated_setup(InputHold truth, Calibration& calibration) {
  DiagnoseOptions options;
  options.starts = 2;
  const Parallel parallel = serially();
  std::vector<Recording> recordings = toys::noisy_tanks({}, 0.01);
  Rng rng(4);
  for (Recording& recording : recordings) {
    for (Eigen::Index i = 0; i < recording.rows(); ++i) recording.inputs(0, i) = std::sin(6 * recording.time[i]);
    auto machine = toys::machine({1.3, 0.8}, {});
    machine.integration.inputs = {truth};
    recording.outputs = simulate_augmented(toys::LeakyTank{}, machine, recording).outputs;
    for (double& level : recording.outputs.reshaped()) level += 0.002 * rng.normal();
  }
  const RunContext run{options, parallel};
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, std::move(recordings), run);
  calibration = calibrate_model(setup, run);
  return setup;
}

TEST_CASE("a calibration finds parameters, and inputs as they are between rows") {
  for (const InputHold truth : {InputHold::zero_order, InputHold::linear, InputHold::before}) {
    Calibration calibration;
    const EstimationSetup setup = calibrated_setup(truth, calibration);
    CHECK(calibration.calibrated.hypothesis.parameters[0] == doctest::Approx(1.3).epsilon(0.02));
    CHECK(calibration.calibrated.hypothesis.parameters[1] == doctest::Approx(0.8).epsilon(0.03));
    CHECK(calibration.training_runs.size() == setup.split.training.size());
    const auto& inputs = setup.problem.integration.inputs;
    CHECK((inputs.empty() ? InputHold::zero_order : inputs[0]) == truth);
    CHECK(setup.bound.integration.inputs == inputs);
    CHECK(setup.problem.weighting.sigma[0] == doctest::Approx(0.002).epsilon(0.2));
    CHECK(error_scale_of(setup).sigma.size() == 1);
  }
}

TEST_CASE("parameters that only fine steps can simulate are not lost to others that coarse ones can") {
  constexpr double truth = 0.002;  // onset of a friction that rows of 50 ms are far too long for
  const NamedEffect friction{"coulomb_friction", "v", "smooth", {}, {1.0, truth}};
  std::vector<Recording> recordings;
  Rng rng(2);
  for (int r = 0; r < 5; ++r) {
    Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 120, 0.05);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      recording.inputs(0, i) = (2 + 0.3 * r) * std::sin((1 + 0.4 * r) * recording.time[i]);
    }
    auto machine = toys::machine({2, 0, 0}, {friction});
    machine.integration.step = 0.0002;
    recording.outputs = simulate_augmented(toys::SlidingBlock{}, machine, recording).outputs;
    for (double& x : recording.outputs.reshaped()) x += 0.001 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  DiagnoseOptions options;
  options.starts = 2;
  options.known = {friction};
  const Parallel parallel = serially();
  const RunContext run{options, parallel};
  const auto bind = [](std::vector<Recording> some) { return bind_simulator(toys::SlidingBlock{}, std::move(some)); };
  EstimationSetup setup = hold_out_recordings(bind, std::move(recordings), run);
  const Hypothesis found = calibrate_model(setup, run).calibrated.hypothesis;
  CHECK(found.values[0][1] / truth == doctest::Approx(1).epsilon(0.2));
  CHECK(found.parameters[0] == doctest::Approx(2).epsilon(0.02));
}

TEST_CASE("a calibration is no worse than its start where a sensor rounds and recordings begin anywhere") {
  const std::vector<NamedEffect> steps{{"quantization", "level_m", "sharp", {}, {0.02}}};
  std::vector<Recording> recordings;
  Rng rng(3);
  for (int r = 0; r < 6; ++r) {
    Recording recording = toys::tank_recording(r, 120);
    recording.initial[0] = 2 * rng.normal();
    recording.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, steps), recording).outputs;
    recording.initial[0] = 0;
    recording.initial_scale[0] = 1;
    recordings.push_back(std::move(recording));
  }
  DiagnoseOptions options;
  options.starts = 2;
  options.known = steps;
  const Parallel parallel = serially();
  const RunContext run{options, parallel};
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, std::move(recordings), run);
  const Hypothesis found = calibrate_model(setup, run).calibrated.hypothesis;
  CHECK(found.values[0][0] == doctest::Approx(0.02).epsilon(0.001));
  CHECK(found.parameters[1] == doctest::Approx(1).epsilon(0.001));
}

}  // namespace
}  // namespace surefoot::diagnosis
