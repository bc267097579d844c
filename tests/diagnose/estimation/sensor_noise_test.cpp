// Noise of sensors, and initial states that were read off one.
#include "surefoot/diagnose/estimation/sensor_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the noise of a sensor is seen through motion that is smooth") {
  const auto seen = [](double memory) {  // noise of 0.01, correlated by so much from row to row
    Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 2400, 0.02);
    Rng rng(2);
    double noise = 0;
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      noise = memory * noise + 0.01 * std::sqrt(1 - memory * memory) * rng.normal();
      recording.outputs(0, i) = noise + 0.5 * std::sin(std::numbers::pi * recording.time[i]);
    }
    return fast_noise(bind_simulator(toys::LeakyTank{}, {recording}), {0}, 0);
  };
  CHECK(seen(0) == doctest::Approx(0.01).epsilon(0.1));
  CHECK(seen(0.6) < 0.01);  // of correlated noise less is seen
  CHECK(fast_noise(bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 20)}), {}, 0) == 0);
}

TEST_CASE("noise and steps are seen in readings with rows between them that were not read") {
  Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 12000, 0.004);
  Rng rng(3);
  const auto keep = [](Eigen::Index row) { return row % 5 == 0 && row % 35 != 0; };  // every fifth, and few are lost
  for (Eigen::Index i = 0; i < recording.rows(); ++i) {
    const double reading = 0.01 * rng.normal() + 0.5 * std::sin(std::numbers::pi * recording.time[i]);
    recording.outputs(0, i) = keep(i) ? reading : std::nan("");
  }
  CHECK(fast_noise(bind_simulator(toys::LeakyTank{}, {recording}), {0}, 0) == doctest::Approx(0.01).epsilon(0.1));

  constexpr double step = 0.2;
  for (double& level : recording.outputs.reshaped()) level = step * std::round(level / step);
  const BoundSimulator coarse = bind_simulator(toys::LeakyTank{}, {recording});
  CHECK(resolution(coarse, {0}, 0) == doctest::Approx(step));
  CHECK(rounding_error(coarse, {0}, 0) == doctest::Approx(step / std::sqrt(12.0)));
}

TEST_CASE("the resolution of a sensor is the least step between readings") {
  Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 100, 0.02);
  for (Eigen::Index i = 0; i < recording.rows(); ++i) {
    recording.outputs(0, i) = 0.003 * std::round(100 * std::sin(0.1 * static_cast<double>(i)));
  }
  CHECK(resolution(bind_simulator(toys::LeakyTank{}, {recording}), {0}, 0) == doctest::Approx(0.003));
  recording.outputs.setConstant(1);
  CHECK(resolution(bind_simulator(toys::LeakyTank{}, {recording}), {0}, 0) == 0);
}

TEST_CASE("an initial state that was read off a sensor is known as well as that sensor reads") {
  auto recordings = toys::servo_recordings(toys::machine({1.4, 3.9, 0.014}), 3, 20);
  for (const std::size_t r : {0U, 1U}) recordings[r].initial[0] = recordings[r].outputs(0, 0);
  BoundSimulator bound = bind_simulator(toys::ServoPendulum{}, recordings);
  free_measured_initial_states(bound, {0, 1, 2});
  for (const std::size_t r : {0U, 1U}) {
    CHECK(bound.recordings[r].initial_scale[0] == doctest::Approx(0.001).epsilon(0.5));
    CHECK(bound.recordings[r].initial_scale[1] == 0);
  }
  CHECK(bound.recordings[2].initial_scale[0] == 0);  // known from elsewhere
}

TEST_CASE("an initial state that was read in coarse steps is known to one of these, though readings show no noise") {
  constexpr double step = 0.2;
  std::vector<Recording> tanks{toys::tank_recording(0, 200), toys::tank_recording(1, 200)};
  for (Recording& one : tanks) {
    one.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, {}), one).outputs;
    for (double& level : one.outputs.reshaped()) level = step * std::floor(level / step);
    one.initial[0] = one.outputs(0, 0);
  }
  BoundSimulator bound = bind_simulator(toys::LeakyTank{}, tanks);
  REQUIRE(fast_noise(bound, {0, 1}, 0) < 0.01 * step);
  free_measured_initial_states(bound, {0, 1});
  CHECK(bound.recordings[0].initial_scale[0] == doctest::Approx(step / std::sqrt(12.0)));

  tanks[0].outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, {}), tanks[0]).outputs;
  CHECK(rounding_error(bind_simulator(toys::LeakyTank{}, {tanks[0]}), {0}, 0) == 0);  // no reading repeats
}

}  // namespace
}  // namespace surefoot::diagnosis
