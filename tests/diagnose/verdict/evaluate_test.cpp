// Evaluation on held-out recordings.
#include "surefoot/diagnose/verdict/evaluate.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

const std::vector<NamedEffect> rate{{"constant_rate", "level", {}, {}, {0.2}}};

TEST_CASE("the interval of a ratio is narrow where all recordings agree, and wide where they do not") {
  const auto [low, high] = ratio_interval({1, 1, 1, 1}, {0.5, 0.5, 0.5, 0.5}, {60, 60, 60, 60}, 1);
  CHECK(low == doctest::Approx(0.5));
  CHECK(high == doctest::Approx(0.5));
  const auto [least, most] = ratio_interval({1, 1, 1, 1}, {0.1, 0.2, 0.4, 0.9}, {60, 60, 60, 60}, 1);
  CHECK(least < 0.3);
  CHECK(most > 0.6);
}

TEST_CASE("a forest helps if its gain is large, sure and seen on held-out recordings") {
  CHECK(forest_helps({.gain = 0.1, .t = 4}, 2, 1.9));
  CHECK_FALSE(forest_helps({.gain = 0.02, .t = 4}, 2, 1.9));
  CHECK_FALSE(forest_helps({.gain = 0.1, .t = 2}, 2, 1.9));
  CHECK_FALSE(forest_helps({.gain = 0.1, .t = 4}, 2, 2.1));
}

TEST_CASE("the noise floor is that of the outputs in their scales") {
  std::vector<ChannelMismatch> outputs(2);
  outputs[0].noise = 0.3;
  outputs[1].noise = 8;
  CHECK(noise_floor(outputs, Vec<2>(0.1, 2)) == doctest::Approx(std::sqrt((9 + 16) / 2.0)));
}

TEST_CASE("errors, curves and intervals are those of the held-out recordings") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(rate, 0.01));
  const FittedModel wrong = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const FittedModels models{wrong, wrong, fitted_model(setup, toys::with_effects(setup, rate), serially())};
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::missing_physics;
  evaluate(setup, models, diagnosis, serially(), 1);
  CHECK(diagnosis.held_out_after < 0.2 * diagnosis.held_out_before);
  CHECK(diagnosis.training_after < 0.2 * diagnosis.training_before);
  CHECK(diagnosis.gain_low <= diagnosis.held_out_after / diagnosis.held_out_before);
  CHECK(diagnosis.gain_high >= diagnosis.held_out_after / diagnosis.held_out_before);
  REQUIRE(diagnosis.curves.size() == 2);
  CHECK(diagnosis.curves[0].recording == "tank 4");
  CHECK(diagnosis.curves[0].nominal == diagnosis.curves[0].before);
  REQUIRE(diagnosis.channels.size() == 1);
  CHECK(diagnosis.channels[0].rmse_after == doctest::Approx(0.01).epsilon(0.1));
  CHECK(diagnosis.channels[0].noise == doctest::Approx(0.01).epsilon(0.15));
  CHECK(diagnosis.channels[0].rmse_nominal > 0.1);
  CHECK(std::isfinite(diagnosis.held_out_forest));
  CHECK_FALSE(diagnosis.forest_residual.tried);  // nothing is unexplained
}

}  // namespace
}  // namespace surefoot::diagnosis
