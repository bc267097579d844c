#include "surefoot/diagnose/effects/quantization.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/effects/detail/sensor_steps.hpp"

using surefoot::effects::lattice_steps;
using surefoot::effects::sawtooth_steps;

TEST_CASE("the step of a coarse sensor is read off its readings, through some noise") {
  surefoot::Rng rng(1);
  for (const double step : {0.02, 0.11}) {
    std::vector<double> readings;
    for (int i = 0; i < 4000; ++i) {
      readings.push_back(step * std::round(std::sin(0.003 * i) / step) + 0.03 * step * rng.normal());
    }
    const auto found = lattice_steps(readings);
    REQUIRE(found.size() == 1);
    CHECK(found.front() == doctest::Approx(step).epsilon(0.02));
  }
}

TEST_CASE("smooth readings have no step, even if they rest at a few places") {
  surefoot::Rng rng(2);
  std::vector<double> readings;
  for (int i = 0; i < 4000; ++i) readings.push_back(std::sin(0.003 * i) + 0.001 * rng.normal());
  CHECK(lattice_steps(readings).empty());
  for (int i = 0; i < 4000; ++i) readings.push_back(0.5 * (i / 1000) + 0.001 * rng.normal());
  CHECK(lattice_steps(readings).empty());
  CHECK(lattice_steps(std::vector<double>(500, 1.0)).empty());
}

TEST_CASE("steps that noise behind the converter hides are found in the errors") {
  surefoot::Rng rng(3);
  for (const double shift : {0.5, 0.0}) {  // rounded, and rounded down
    CAPTURE(shift);
    constexpr double step = 0.03;
    std::vector<double> simulated, readings, noise;
    for (int i = 0; i < 4000; ++i) {
      simulated.push_back(std::sin(0.003 * i));
      noise.push_back(simulated.back() + 0.3 * step * rng.normal());
      readings.push_back(step * std::floor(simulated.back() / step + shift) + 0.3 * step * rng.normal());
    }
    CHECK(lattice_steps(readings).empty());
    const auto found = sawtooth_steps(readings, simulated);
    REQUIRE(found.size() == 1);
    CHECK(found.front() == doctest::Approx(step).epsilon(0.001));
    CHECK(sawtooth_steps(noise, simulated).empty());
  }
}

TEST_CASE("steps are found by a simulation that is off by part of one, here or there") {
  surefoot::Rng rng(5);
  constexpr double step = 0.02;
  std::vector<double> simulated, readings;
  for (int i = 0; i < 2000; ++i) {
    const double value = 5 + 4 * std::sin(0.003 * i);
    simulated.push_back(value + step * (i % 500 < 250 ? 0.6 : 0.9));  // recordings begin a little elsewhere
    readings.push_back(step * std::floor(value / step) + 0.35 * step * rng.normal());
  }
  const auto found = sawtooth_steps(readings, simulated);
  REQUIRE(found.size() == 1);
  CHECK(found.front() == doctest::Approx(step).epsilon(0.001));
}

TEST_CASE("errors where a machine rests show no steps, however many readings there are") {
  surefoot::Rng rng(4);
  std::vector<double> simulated, readings;
  const auto read = [&](double value, double error) {
    simulated.push_back(value);
    readings.push_back(value + error + 0.01 * rng.normal());
  };
  for (int i = 0; i < 600; ++i) read(-1 + i / 300.0, 0);
  for (const auto& [place, error] : {std::pair{0.285, 0.03}, {0.335, -0.03}, {0.385, 0.02}}) {
    for (int i = 0; i < 600; ++i) read(place, error);
  }
  CHECK(sawtooth_steps(readings, simulated).empty());
}
