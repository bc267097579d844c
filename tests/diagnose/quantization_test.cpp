#include "surefoot/diagnose/effects/quantization.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/rng.hpp"

using surefoot::effects::lattice_steps;

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
