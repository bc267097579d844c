// The location of a mismatch.
#include "surefoot/diagnose/verdict/locate_mismatch.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the stretches that are off are found, and final poses have none") {
  auto recordings = toys::noisy_tanks({}, 0.001);
  recordings[1].outputs.middleCols(60, 12).array() += 0.5;
  EstimationSetup setup = toys::tank_setup(recordings);
  const FittedModel model = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const auto [regions, intervals] = locate_mismatch(setup, model, 1);
  REQUIRE_FALSE(intervals.empty());
  CHECK(intervals.front().recording == "tank 1");
  CHECK(intervals.front().from > 2.5);
  CHECK(intervals.front().to < 4.3);
  setup.noise = NoiseKind::final_pose;
  CHECK(locate_mismatch(setup, model, 1).first.empty());
  CHECK(locate_mismatch(setup, model, 1).second.empty());
}

}  // namespace
}  // namespace surefoot::diagnosis
