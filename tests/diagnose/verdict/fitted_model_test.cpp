// Fitted models: what is simulated, and from where.
#include "surefoot/diagnose/verdict/fitted_model.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a model is simulated over training and held-out recordings, and its mismatch is that of the training") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(toys::extra_inflow(), 0.01));
  const FittedModel wrong = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const FittedModel right = fitted_model(setup, toys::with_effects(setup, toys::extra_inflow()), serially());
  CHECK(right.runs.training.size() == 4);
  CHECK(right.runs.held_out.size() == 2);
  CHECK(right.runs.whole_held_out[1].outputs == right.runs.held_out[1].outputs);
  REQUIRE(right.by_output.size() == 1);
  CHECK(wrong.mismatch.share > 0.8);
  CHECK(wrong.mismatch.p_value < 1e-3);
  CHECK(right.mismatch.energy < 0.05 * wrong.mismatch.energy);
}

TEST_CASE("where rows are predicted one by one the whole recordings are simulated beside them") {
  EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(toys::extra_inflow(), 0.01));
  setup.bound.integration.restart = 1;
  const FittedModel model = simulate_model(setup, nominal_hypothesis(setup.bound), serially());
  const Eigen::MatrixXd& measured = setup.bound.recordings[4].outputs;
  const double stepwise = (model.runs.held_out[0].outputs - measured).norm();
  CHECK(stepwise < 0.3 * (model.runs.whole_held_out[0].outputs - measured).norm());
}

TEST_CASE("unknown initial states of held-out recordings are estimated, others stay") {
  auto recordings = toys::noisy_tanks({}, 0.001);
  Recording& held_out = recordings[5];
  held_out.initial[0] = 0.3;
  held_out.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}), held_out).outputs;
  held_out.initial[0] = 0;
  held_out.initial_scale[0] = 0.1;
  const EstimationSetup setup = toys::tank_setup(recordings);
  const FittedModel model = simulate_model(setup, nominal_hypothesis(setup.bound), serially());
  CHECK(model.hypothesis.initial[5][0] == doctest::Approx(0.3).epsilon(0.01));
  CHECK(model.hypothesis.initial[4][0] == 0);
}

}  // namespace
}  // namespace surefoot::diagnosis
