// Evaluation on held-out recordings.
#include "surefoot/diagnose/verdict/evaluate.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

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

TEST_CASE("where the noise of an output cannot be told no floor is") {
  std::vector<ChannelMismatch> outputs(2);
  outputs[0].noise = 0.3;
  CHECK(std::isnan(noise_floor(outputs, Vec<2>(0.1, 2))));
}

TEST_CASE("the noise of an output that is read in every tenth row is that of these readings") {
  auto recordings = toys::noisy_tanks({}, 0.01);
  for (Recording& one : recordings) {
    for (Eigen::Index row = 0; row < one.rows(); ++row) {
      if (row % 10 != 0) one.outputs(0, row) = std::nan("");
    }
  }
  const EstimationSetup setup = toys::tank_setup(std::move(recordings));
  const FittedModel right = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  Diagnosis diagnosis;
  evaluate_errors(setup, {right, right, right}, diagnosis, 1);
  CHECK(diagnosis.channels.at(0).noise == doctest::Approx(0.01).epsilon(0.3));
  CHECK(diagnosis.noise_ratio == doctest::Approx(1).epsilon(0.3));
}

TEST_CASE("a coarse sensor does not hide what a fine one shows") {
  std::vector<ChannelMismatch> outputs(2);
  outputs[0].rmse_after = 0.07;  // of a motion that is as wide as that of the other
  outputs[0].noise = 0.01;
  outputs[1].rmse_after = outputs[1].noise = 0.2;
  CHECK(noise_ratio(outputs) == doctest::Approx(5));
  outputs[0].noise_amplification = 7;  // of predictions: nothing but noise is left there either
  CHECK(noise_ratio(outputs) == doctest::Approx(1));
  outputs[0].noise_amplification = 1;
  outputs[1].noise = 0;
  CHECK(std::isnan(noise_ratio(outputs)));
}

TEST_CASE("the noise of an output is what no lag predicts, unless it is stated") {
  EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const auto noise = [&](double predicted, double p, double typical = 0.03) {
    const WhitenessTest residuals{.share = 0.2, .predicted = predicted, .p_value = p, .typical = typical};
    return output_noise(setup.bound, setup.split.training, 0, residuals, {}, 0.2);
  };
  CHECK(noise(0.75, 1e-6) == doctest::Approx(0.015));
  CHECK(noise(0.75, 0.5) == doctest::Approx(0.03));             // by chance
  CHECK(noise(1, 1e-6) == doctest::Approx(0.01).epsilon(0.2));  // what differs from row to row is left
  CHECK(noise(0, 0.5, 0.1) == doctest::Approx(0.04).epsilon(0.2));  // no more than four times that
  const auto with_spectrum = [&](double power, double error) {
    const FastSpectrum white{.frequency = {1, 2, 3}, .power = {power, power, power}};
    return output_noise(setup.bound, setup.split.training, 0, {.typical = 0.1}, white, error);
  };
  CHECK(with_spectrum(0.0004, 0.2) == doctest::Approx(0.02));
  const auto by_slow_spectrum = [&](double p) {  // as 1 / frequency^2
    const FastSpectrum slow{.frequency = {0.8, 1.2, 1.6}, .power = {0.09, 0.04, 0.0225}};
    return output_noise(setup.bound, setup.split.training, 0, {.predicted = 0.9, .p_value = p, .typical = 0.03}, slow,
                        1);
  };
  CHECK(by_slow_spectrum(1e-6) == doctest::Approx(0.15));
  CHECK(by_slow_spectrum(0.5) == doctest::Approx(0.03));  // nothing lasts: all of it is noise
  for (Recording& one : setup.bound.recordings) {
    for (double& level : one.outputs.reshaped()) level = std::round(level);  // a sensor that rarely moves
  }
  CHECK(noise(0, 0.5, 0.1) == doctest::Approx(0.1));
  CHECK(with_spectrum(0.0004, 0.01) == 0.01);                               // never more than the error
  CHECK(with_spectrum(0.0004, 2) == doctest::Approx(1 / std::sqrt(12.0)));  // readings are whole numbers
  CHECK(with_spectrum(0, 0.02) == 0.02);
  setup.bound.info.outputs[0].noise = 0.03;
  CHECK(noise(0.75, 1e-6) == 0.03);
}

TEST_CASE("estimated noise is no more than what any model leaves, stated noise stays") {
  Diagnosis diagnosis;
  diagnosis.channels.resize(2);
  for (ChannelMismatch& one : diagnosis.channels) {
    one.noise = 0.2;
    one.rmse_after = 0.3;
  }
  diagnosis.channels[1].noise_stated = true;
  const Vec<2> scale(1, 1);
  diagnosis.noise_floor = noise_floor(diagnosis.channels, scale);
  diagnosis.noise_ratio = noise_ratio(diagnosis.channels);
  cap_noise(diagnosis, 0.25, scale);
  CHECK(diagnosis.channels[0].noise == 0.2);  // nothing leaves less
  cap_noise(diagnosis, std::sqrt((0.2 * 0.2 + 0.1 * 0.1) / 2), scale);
  CHECK(diagnosis.channels[0].noise == doctest::Approx(0.1));
  CHECK(diagnosis.channels[1].noise == 0.2);
  CHECK(diagnosis.noise_floor == doctest::Approx(std::sqrt((0.2 * 0.2 + 0.1 * 0.1) / 2)));
  CHECK(diagnosis.noise_ratio == doctest::Approx(std::sqrt((9 + 2.25) / 2)));
  cap_noise(diagnosis, 0.01, scale);  // less than is stated: that was overstated
  CHECK(diagnosis.channels[0].noise == doctest::Approx(0.1));
}

TEST_CASE("errors, curves and intervals are those of the held-out recordings") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(toys::extra_inflow(), 0.01));
  const FittedModel wrong = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const FittedModels models{wrong, wrong,
                            fitted_model(setup, toys::with_effects(setup, toys::extra_inflow()), serially())};
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::missing_physics;
  evaluate_errors(setup, models, diagnosis, 1);
  offer_forests(setup, models, diagnosis, serially(), 1);
  CHECK(diagnosis.noise_ratio == doctest::Approx(1).epsilon(0.2));
  CHECK(diagnosis.held_out_after < 0.2 * diagnosis.held_out_before);
  CHECK(diagnosis.training_after < 0.2 * diagnosis.training_before);
  REQUIRE(diagnosis.per_recording.size() == 2);
  for (const RecordingFit& one : diagnosis.per_recording) {
    CHECK(one.independent > 40);  // of 119 that were measured: white noise, as far as can be seen
    CHECK(one.independent <= 119);
  }
  CHECK(diagnosis.gain_low <= diagnosis.held_out_after / diagnosis.held_out_before);
  CHECK(diagnosis.gain_high >= diagnosis.held_out_after / diagnosis.held_out_before);
  REQUIRE(diagnosis.curves.size() == 2);
  CHECK(diagnosis.curves[0].recording == "tank 4");
  CHECK(diagnosis.curves[0].nominal == diagnosis.curves[0].before);
  REQUIRE(diagnosis.channels.size() == 1);
  CHECK(diagnosis.channels[0].rmse_after == doctest::Approx(0.01).epsilon(0.1));
  CHECK(diagnosis.channels[0].noise == doctest::Approx(0.01).epsilon(0.15));
  CHECK(diagnosis.channels[0].rmse_nominal > 0.1);
  CHECK_FALSE(diagnosis.forest_residual.tried);  // nothing is unexplained
}

// Tanks whose measured level is off by a wave of the true level that no effect in the tank explains.
ForestResidual offered(double wave, Verdict verdict, bool cross_fitted = false) {
  auto recordings = toys::noisy_tanks({}, 0.01, 8);
  for (Recording& recording : recordings) {
    for (double& level : recording.outputs.reshaped()) level += wave * std::sin(20 * level);
  }
  EstimationSetup setup = toys::tank_setup(recordings);
  setup.split = {{0, 1, 2, 3, 4, 5}, {6, 7}, {{0, 1}, {2, 3}, {4, 5}}};
  if (cross_fitted)
    setup.split = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {{0, 1, 2, 3}, {4, 5, 6, 7}}, true};
  const FittedModel model = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  Diagnosis diagnosis;
  diagnosis.verdict = verdict;
  const FittedModels models{model, model, model};
  evaluate_errors(setup, models, diagnosis, 1);
  offer_forests(setup, models, diagnosis, serially(), 1);
  return diagnosis.forest_residual;
}

TEST_CASE(
    "a forest is offered where nothing explains a mismatch, and kept only where it helps on what it has not seen") {
  const ForestResidual helps = offered(0.05, Verdict::unexplained);
  CHECK(helps.tried);
  CHECK(helps.kept);
  CHECK(helps.gain > 2 * helps.gain_stderr);
  CHECK(helps.held_out_after < 0.8 * helps.held_out_before);
  const ForestResidual noise = offered(0, Verdict::unexplained);
  CHECK(noise.tried);
  CHECK_FALSE(noise.kept);
  CHECK_FALSE(offered(0.05, Verdict::missing_physics).tried);
}

TEST_CASE("where each recording is held out once no forest corrects what it was trained on") {
  const ForestResidual helps = offered(0.05, Verdict::unexplained, true);
  CHECK(helps.kept);
  CHECK(helps.held_out_after < 0.8 * helps.held_out_before);
  const ForestResidual noise = offered(0, Verdict::unexplained, true);
  CHECK(noise.tried);
  CHECK(noise.held_out_after > 0.97 * noise.held_out_before);  // one that knew the noise by heart would be far below
  CHECK_FALSE(noise.kept);
}

}  // namespace
}  // namespace surefoot::diagnosis
