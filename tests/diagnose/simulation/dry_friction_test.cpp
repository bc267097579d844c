// Dry friction in simulations against exact solutions: where things stop, and when they do not move at all.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::blank_recording;
using toys::SlidingBlock;

// mass, damping, stiffness; level of dry friction [N]; longest step [s]
Augmented rubbing(std::vector<double> parameters, double level, double step) {
  return {.parameters = std::move(parameters),
          .effects = {{.name = "coulomb_friction", .attached_to = "v", .values = {level}}},
          .integration = {.step = step}};
}

TEST_CASE("a sliding block stops after v^2 / (2 mu g), whatever the step") {
  constexpr double mu_g = 0.3 * 9.81, speed = 1.7;
  Recording recording = blank_recording(SlidingBlock{}.info(), 11, 0.1);
  recording.initial[1] = speed;
  for (const double step : {0.1, 0.037, 0.01, 0.001}) {
    const SimulatedRun run = simulate_augmented(SlidingBlock{}, rubbing({2, 0, 0}, 2 * mu_g, step), recording);
    CHECK(run.outputs(0, 10) == doctest::Approx(speed * speed / (2 * mu_g)).epsilon(1e-10));
    CHECK(run.outputs(1, 10) == 0);
    CHECK(run.outputs(1, 5) == doctest::Approx(speed - 0.5 * mu_g));
  }
}

TEST_CASE("with a damper, too, the error of where it stops falls with the square of the step at least") {
  constexpr double m = 2, c = 3, level = 4, speed = 2;
  const double exact = m / c * (speed - level / c * std::log1p(c * speed / level));
  Recording recording = blank_recording(SlidingBlock{}.info(), 11, 0.2);
  recording.initial[1] = speed;
  for (const double step : {0.2, 0.07, 0.05, 0.02, 0.01}) {
    const SimulatedRun run = simulate_augmented(SlidingBlock{}, rubbing({m, c, 0}, level, step), recording);
    CHECK(std::abs(run.outputs(0, 10) - exact) < 0.05 * step * step);
  }
}

TEST_CASE("a force below breakaway moves nothing, one above it moves by what is left of it") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 21, 0.05);
  recording.inputs.setConstant(2.97);
  const SimulatedRun stuck = simulate_augmented(SlidingBlock{}, rubbing({2, 0, 0}, 3, 0), recording);
  CHECK((stuck.outputs.array() == 0).all());
  recording.inputs.setConstant(-3.5);
  const SimulatedRun moving = simulate_augmented(SlidingBlock{}, rubbing({2, 0, 0}, 3, 0), recording);
  CHECK(moving.outputs(1, 20) == doctest::Approx(-0.25));
  CHECK(moving.outputs(0, 20) == doctest::Approx(-0.125));
}

TEST_CASE("a spring loses 2 F / k of its swing in every half period, and rests where the friction holds it") {
  constexpr double k = 50, level = 3;  // 5 rad/s; stuck within 0.06 m
  Recording recording = blank_recording(SlidingBlock{}.info(), 600, 0.01);
  recording.initial[0] = 0.5;
  const SimulatedRun run = simulate_augmented(SlidingBlock{}, rubbing({2, 0, k}, level, 0.002), recording);
  double swing = 0.5;
  for (int half = 1; half <= 4; ++half) {
    swing -= 2 * level / k;
    const auto row = static_cast<Eigen::Index>(std::lround(half * std::numbers::pi / 5 / 0.01));
    CHECK(std::abs(run.outputs(0, row)) == doctest::Approx(swing).epsilon(0.01));
  }
  CHECK(run.outputs(0, 599) == doctest::Approx(swing).epsilon(1e-3));
  CHECK(run.outputs(1, 599) == 0);
}

TEST_CASE("several dry frictions of one velocity add up") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 11, 0.1);
  Augmented both = rubbing({2, 0, 0}, 1.5, 0);
  both.effects.push_back(both.effects.front());
  recording.inputs.setConstant(2.9);
  CHECK(simulate_augmented(SlidingBlock{}, both, recording).outputs(0, 10) == 0);
  recording.inputs.setConstant(4);
  CHECK(simulate_augmented(SlidingBlock{}, both, recording).outputs(1, 10) == doctest::Approx(0.5));
}

}  // namespace
}  // namespace surefoot::diagnosis
