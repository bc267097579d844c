// Calibration as a stage: parameters, integration and sizes, and what recordings say of inputs.
#include "surefoot/diagnose/verdict/calibrate_model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/diagnose/verdict/pipeline.hpp"
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

}  // namespace
}  // namespace surefoot::diagnosis
