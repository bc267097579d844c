// Reasons not to start.
#include "examples/sigmaban/robot/servos/start_check.hpp"

#include <doctest/doctest.h>

using namespace dynamixel;

TEST_CASE("a joint starts where supply, temperature, errors and place are as they should be") {
  const Joint knee{.name = "knee", .id = 4, .min_rad = -0.1, .max_rad = 2};
  const auto why = [&](auto change) {
    StartState state{.position_rad = 0.5, .voltage_v = 12, .temperature_celsius = 35};
    change(state);
    return why_not_to_start(knee, state).value_or("");
  };
  CHECK(why([](auto&) {}).empty());
  CHECK(why([](auto& s) { s.voltage_v = 10.4; }) ==
        "has a supply of 10.4 V, below 10.5 V; charge or change the battery");
  CHECK(why([](auto& s) { s.voltage_v = 16.5; }).starts_with("has a supply of 16.5 V, above the 14.8 V"));
  CHECK(why([](auto& s) { s.temperature_celsius = 90; }).starts_with("is 90 degrees C hot"));
  CHECK(why([](auto& s) { s.hardware_error = protocol2::overload_error; }).starts_with("reports a hardware error"));
  CHECK(why([](auto& s) { s.hardware_error = protocol2::input_voltage_error; }).empty());  // the voltage itself counts
  CHECK(why([](auto& s) { s.position_rad = 2.4; }).empty());  // limp, it may lie a little beyond
  CHECK(why([](auto& s) { s.position_rad = -0.7; }).starts_with("is at -0.70 rad, far beyond"));
}
