// Effects by name: found with their places, and refused with a sentence that helps.
#include "surefoot/diagnose/effects/named_effect.hpp"

#include <doctest/doctest.h>

#include <string>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "tests/support/servo_pendulum.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot {
namespace {

const SimulatorInfo servo = toys::ServoPendulum{}.info();

std::string refusal_of_named(const NamedEffect& named) {
  try {
    attach(servo, named, all_effects());
  } catch (const DiagnoseError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("an effect attaches to the state, input, output or parameter of that name") {
  const auto effects = all_effects();
  CHECK(attach(servo, {"coulomb_friction", "omega", {}, {}, {0.1}}, effects).at == 1);
  CHECK(attach(servo, {"input_gain", "goal", {}, {}, {0.1}}, effects).at == 0);
  CHECK(attach(servo, {"sensor_bias", "theta_rad", {}, {}, {0.1}}, effects).at == 0);
  CHECK(attach(servo, {"parameter_drift", "armature", {}, {}, {0.1}}, effects).at == 2);
  CHECK(attach(servo, {"coulomb_friction", "omega", {}, {}, {0.1}}, effects).label() == "coulomb_friction at omega");
}

TEST_CASE("signals follow the inputs") {
  const auto effects = all_effects();
  CHECK(attach(servo, {"dead_zone", "duty", {}, {}, {0.1}}, effects).at == 1);
  CHECK(attach(servo, {"dead_zone", "tau", {}, {}, {0.1}}, effects).at == 2);
}

TEST_CASE("forms of one name are told apart, and one name may mean several places") {
  const auto effects = all_effects();
  CHECK(attach(servo, {"dead_zone", "duty", "step", {}, {0.1}}, effects).effect->form == "step");
  CHECK(attach(servo, {"dead_zone", "duty", {}, {}, {0.1}}, effects).effect->form.empty());
  CHECK(refusal_of_named({"dead_zone", "duty", "square", {}, {0.1}})
            .find("there is no effect 'dead_zone' of form 'square'") == 0);
}

TEST_CASE("what does not exist is refused with a list of what there is") {
  const std::string ghost = refusal_of_named({"ghost", "omega", {}, {}, {}});
  CHECK(ghost.find("there is no effect 'ghost'; there are: ") == 0);
  CHECK(ghost.find("coulomb_friction") != std::string::npos);
  CHECK(refusal_of_named({"coulomb_friction", "elbow", {}, {}, {0.1}}) ==
        "effect 'coulomb_friction' cannot attach to 'elbow'");
  CHECK(refusal_of_named({"body_drift", "planar", {}, {}, {0, 0, 0}}) ==
        "effect 'body_drift' cannot attach to 'planar'");
  CHECK(attach(toys::WalkingRobot{}.info(), {"body_drift", "planar", {}, {}, {0, 0, 0}}, all_effects()).at == 0);
}

TEST_CASE("a wrong number of values, or a second state that does not exist, is refused") {
  CHECK(refusal_of_named({"coulomb_friction", "omega", {}, {}, {0.1, 0.2}}) ==
        "effect 'coulomb_friction' has 1 parameters, got 2");
  CHECK(refusal_of_named({"coulomb_friction", "omega", {}, "elbow", {0.1}}) ==
        "effect 'coulomb_friction': there is no state 'elbow'");
  CHECK(attach(servo, {"coulomb_friction", "omega", {}, "theta", {0.1}}, all_effects()).other == 0);
}

TEST_CASE("bounds go with the values, one for each") {
  const AttachedEffect bounded =
      attach(servo, {"coulomb_friction", "omega", {}, {}, {0.1}, {{0.05, 0.2}}}, all_effects());
  REQUIRE(bounded.bounds.size() == 1);
  CHECK(bounded.bounds[0].high == 0.2);
  CHECK(refusal_of_named({"coulomb_friction", "omega", {}, {}, {0.1}, {{0, 1}, {0, 1}}}) ==
        "effect 'coulomb_friction' has 1 values, but bounds for 2");
}

}  // namespace
}  // namespace surefoot
