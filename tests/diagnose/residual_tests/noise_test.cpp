// What is said about noise: each kind by its name, and nothing about white noise or missing physics.
#include "surefoot/diagnose/residual_tests/noise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "tests/diagnose/made_up_noise.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot::diagnosis {
namespace {

const OutputInfo angle{"theta_rad", "rad"};

std::vector<NoiseFinding> found(const ResidualNoise& truth, std::uint64_t seed) {
  return find_noise(toys::noise_recordings(truth, 6, 600, 0.005, seed), angle, SimulatorKind::ode);
}

TEST_CASE("white noise of constant size is called nothing else") {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const int recordings = 2 + static_cast<int>(seed % 6);
    const Eigen::Index rows = 60 + 20 * static_cast<Eigen::Index>(seed % 13);
    const auto series = toys::noise_recordings({.rest = 0.001}, recordings, rows, 0.005, seed);
    alarms += find_noise(series, angle, SimulatorKind::ode).empty() ? 0 : 1;
  }
  CHECK(alarms <= 2);
}

TEST_CASE("white noise with heavy tails is called nothing else") {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 15; ++seed) {
    auto series = toys::noise_recordings({.rest = 0.001}, 5, 300, 0.005, seed);
    for (NoiseSeries& one : series) one.value = one.value.unaryExpr([](double v) { return v * std::abs(v) * 1e3; });
    alarms += find_noise(series, angle, SimulatorKind::ode).empty() ? 0 : 1;
  }
  CHECK(alarms <= 1);
}

TEST_CASE("noise that grows with speed is recognised and measured") {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const auto findings = found({.rest = 0.001, .growth = 0.002}, seed);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].name == "speed_dependent_noise");
    CHECK(findings[0].output == "theta_rad");
    REQUIRE(findings[0].parameters.size() == 2);
    CHECK(findings[0].parameters[0].value == doctest::Approx(0.001).epsilon(0.15));
    CHECK(findings[0].parameters[0].unit == "rad");
    CHECK(findings[0].parameters[1].value == doctest::Approx(0.002).epsilon(0.06));
    CHECK(findings[0].parameters[1].unit == "s");
    CHECK(findings[0].gain > 0.1);
    CHECK(findings[0].p_value < 1e-3);
    CHECK(findings[0].sentence.starts_with("noise of theta_rad grows with its speed, from 0.0"));
  }
}

TEST_CASE("noise that is correlated from row to row is recognised and measured") {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const auto findings = found({.rest = 0.001, .time = 0.01, .share = 1}, seed);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].name == "correlated_noise");
    CHECK(findings[0].parameters[0].value == doctest::Approx(0.01).epsilon(0.12));
    CHECK(findings[0].parameters[0].unit == "s");
    CHECK(findings[0].sentence.starts_with("noise of theta_rad is correlated over 0.0"));
  }
}

TEST_CASE("strengths are right within a few percent where there is enough to see") {
  const auto series =
      toys::noise_recordings({.rest = 0.001, .growth = 0.002, .time = 0.01, .share = 1}, 10, 3000, 0.005, 1);
  const auto findings = find_noise(series, angle, SimulatorKind::ode);
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].parameters[0].value == doctest::Approx(0.001).epsilon(0.06));
  CHECK(findings[0].parameters[1].value == doctest::Approx(0.002).epsilon(0.06));
  CHECK(findings[1].parameters[0].value == doctest::Approx(0.01).epsilon(0.06));
}

TEST_CASE("both kinds are found together") {
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    const auto findings = found({.rest = 0.001, .growth = 0.002, .time = 0.01, .share = 1}, seed);
    REQUIRE(findings.size() == 2);
    CHECK(findings[0].name == "speed_dependent_noise");
    CHECK(findings[1].name == "correlated_noise");
  }
}

TEST_CASE("of what is correlated for long, and may be missing physics, nothing is said") {
  CHECK(found({.rest = 0.001, .time = 0.3, .share = 1}, 1).empty());    // too long for noise
  CHECK(found({.rest = 0.001, .time = 0.3, .share = 0.3}, 1).empty());  // a slow part beside white noise
  std::vector<NoiseSeries> series = toys::noise_recordings({.rest = 0.001}, 6, 600, 0.005, 2);
  for (NoiseSeries& one : series) one.value += 0.001 * one.time.unaryExpr([](double t) { return std::sin(7 * t); });
  CHECK(find_noise(series, angle, SimulatorKind::ode).empty());
}

TEST_CASE("in steps of a map, time is counted in rows") {
  const auto series = toys::noise_recordings({.rest = 0.01, .time = 1.5, .share = 1}, 40, 26, 1, 5);
  const auto findings = find_noise(series, {"x_m", "m"}, SimulatorKind::map);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].parameters[0].unit == "rows");
  CHECK(findings[0].parameters[0].value == doctest::Approx(1.5).epsilon(0.3));
}

TEST_CASE("residuals of simulated recordings: each output is judged by itself") {
  std::vector<Recording> recordings;
  std::vector<std::size_t> all;
  for (int r = 0; r < 6; ++r) {
    Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 500, 0.01);
    for (Eigen::Index i = 0; i < 500; ++i) recording.inputs(0, i) = 4 * std::cos((2 + 0.3 * r) * recording.time[i]);
    recording.outputs = simulate_augmented(toys::SlidingBlock{}, {}, recording).outputs;
    Rng rng(7, static_cast<std::uint64_t>(r));
    double fading = 0;
    for (Eigen::Index i = 1; i < 500; ++i) {
      recording.outputs(0, i) += std::hypot(0.001, 0.004 * recording.outputs(1, i)) * rng.normal();
      fading = 0.6 * fading + 0.01 * rng.normal();
      recording.outputs(1, i) += fading;
    }
    recording.outputs(0, 100) += 3;  // an outlier
    recordings.push_back(recording);
    all.push_back(static_cast<std::size_t>(r));
  }
  BoundSimulator bound = bind_simulator(toys::SlidingBlock{}, recordings);
  const auto findings = find_noise(bound, nominal_hypothesis(bound), all, NoiseKind::measurement, serially());
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].output == "x_m");
  CHECK(findings[0].name == "speed_dependent_noise");
  CHECK(findings[0].parameters[1].value == doctest::Approx(0.004).epsilon(0.1));
  CHECK(findings[1].output == "v_mps");
  CHECK(findings[1].name == "correlated_noise");
  CHECK(findings[1].parameters[0].value == doctest::Approx(-0.01 / std::log(0.6)).epsilon(0.1));

  // Coarse readings hide it.
  for (Recording& recording : bound.recordings) {
    recording.outputs = recording.outputs.unaryExpr([](double v) { return std::round(v / 0.2) * 0.2; });
  }
  CHECK(find_noise(bound, nominal_hypothesis(bound), all, NoiseKind::measurement, serially()).empty());
  CHECK(find_noise(bound, nominal_hypothesis(bound), all, NoiseKind::final_pose, serially()).empty());
}

TEST_CASE("noise that accumulates is judged step by step") {
  const auto nothing = [](Pose2 moved, Pose2 /*at*/) { return moved; };
  BoundSimulator bound = bind_simulator(toys::WalkingRobot{}, toys::walk_recordings(nothing, false, 60, 3));
  bound.integration.restart = 1;
  Hypothesis truth = nominal_hypothesis(bound);
  truth.parameters << 1.2, 0.9, 1.1;
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) all.push_back(r);
  CHECK(find_noise(bound, truth, all, NoiseKind::process, serially()).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis
