// Fitted models: what is simulated, and from where.
#include "surefoot/diagnose/verdict/fitted_model.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

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

// Tanks of which each is held out once, in three folds.
EstimationSetup cross_fitted_tanks(std::vector<Recording> recordings) {
  EstimationSetup setup = toys::tank_setup(std::move(recordings));
  setup.split = {{0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5}, {{0, 3}, {1, 4}, {2, 5}}, true};
  setup.problem.recordings = setup.split.training;
  return setup;
}

TEST_CASE("where each recording is held out once it has no say in the fit that it is held out of, and in all others") {
  auto recordings = toys::noisy_tanks({}, 0.01);
  const EstimationSetup plain = cross_fitted_tanks(recordings);
  const FittedModel before = simulate_model(plain, nominal_hypothesis(plain.bound), serially(), true);
  REQUIRE(before.runs.held_out.size() == 6);
  for (const std::size_t odd : {0u, 4u}) {
    auto changed = recordings;
    changed[odd].outputs *= 1.5;
    const EstimationSetup setup = cross_fitted_tanks(changed);
    const FittedModel after = simulate_model(setup, nominal_hypothesis(setup.bound), serially(), true);
    for (const auto& fold : setup.split.folds) {
      const bool held_out_with_it = std::ranges::find(fold, odd) != fold.end();
      for (const std::size_t r : fold) {
        CHECK((after.runs.held_out[r].outputs == before.runs.held_out[r].outputs) == held_out_with_it);
      }
    }
  }
}

TEST_CASE("a model that is not fitted again simulates held-out recordings with its own parameters") {
  const EstimationSetup setup = cross_fitted_tanks(toys::noisy_tanks(toys::extra_inflow(), 0.01));
  const FittedModel model = simulate_model(setup, nominal_hypothesis(setup.bound), serially());
  for (std::size_t r = 0; r < 6; ++r) {
    CHECK(model.runs.held_out[r].outputs == model.runs.training[r].outputs);
    CHECK(model.runs.whole_held_out[r].outputs == model.runs.whole_training[r].outputs);
  }
}

TEST_CASE("parameters that fit one recording only are of no use to it when it is held out") {
  auto recordings = toys::noisy_tanks({}, 0.01);
  recordings[2].outputs *= 2;
  EstimationSetup setup = cross_fitted_tanks(recordings);
  setup.split.folds = {{0}, {1}, {2}, {3}, {4}, {5}};
  const FittedModel model = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  CHECK((2 * model.runs.held_out[2].outputs - recordings[2].outputs).norm() < 0.05 * recordings[2].outputs.norm());
}

TEST_CASE("unknown initial states are estimated of recordings that are held out of the fit as well") {
  auto recordings = toys::noisy_tanks({}, 0.001);
  recordings[5].initial[0] = 0.3;
  recordings[5].outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}), recordings[5]).outputs;
  recordings[5].initial[0] = 0;
  recordings[5].initial_scale[0] = 0.1;
  const EstimationSetup setup = cross_fitted_tanks(recordings);
  const FittedModel model = simulate_model(setup, nominal_hypothesis(setup.bound), serially(), true);
  CHECK((model.runs.held_out[5].outputs - recordings[5].outputs).cwiseAbs().maxCoeff() < 0.01);
}

}  // namespace
}  // namespace surefoot::diagnosis
