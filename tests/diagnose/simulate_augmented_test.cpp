// Simulations with the effects that a diagnosis found.
#include "surefoot/diagnose/simulate_augmented.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/diagnose/small_simulators.hpp"

namespace surefoot {
namespace {

TEST_CASE("without parameters and effects a simulator runs with its nominal values") {
  const Recording recording = toys::tank_recording(1, 60);
  const SimulatedRun nominal = simulate_augmented(toys::LeakyTank{}, {}, recording);
  CHECK(nominal.outputs == simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}), recording).outputs);
  CHECK(nominal.finite);
  CHECK(nominal.states.row(0) == nominal.outputs.row(0));
}

TEST_CASE("an effect acts with its values, in units of the model") {
  Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 101, 0.01);
  recording.inputs.setConstant(3);
  const auto pushed = toys::machine({2, 0, 0}, {{"coulomb_friction", "v", {}, {}, {1}}});
  const SimulatedRun run = simulate_augmented(toys::SlidingBlock{}, pushed, recording);
  CHECK(run.states(1, 100) == doctest::Approx((3.0 - 1.0) / 2.0));  // (push - friction) / mass, after 1 s
}

TEST_CASE("an effect that is not there, or that does not fit, is refused") {
  const Recording recording = toys::tank_recording(1, 20);
  CHECK_THROWS_AS(
      simulate_augmented(toys::LeakyTank{}, toys::machine({}, {{"unheard_of", "level", {}, {}, {}}}), recording),
      DiagnoseError);
  const Effect idle{.name = "idle", .place = Place::input};
  CHECK_THROWS_WITH_AS(
      simulate_augmented(toys::LeakyTank{}, toys::machine({}, {{"idle", "valve", {}, {}, {}}}), recording, {idle}),
      doctest::Contains("'idle': does nothing"), DiagnoseError);
}

}  // namespace
}  // namespace surefoot
