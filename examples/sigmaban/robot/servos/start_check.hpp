// Reasons not to switch the torque of a joint on.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "../bus/protocols.hpp"
#include "alarms.hpp"
#include "joint.hpp"

namespace dynamixel {

/// What was measured before the start.
struct StartState {
  double position_rad = 0;  // of the joint
  double voltage_v = 0;
  double temperature_celsius = 0;
  std::uint32_t hardware_error = 0;  // bits of protocol2::HardwareErrorBit
};

struct StartCriteria {
  AlarmOptions alarms{};
  double most_beyond_limits_rad = 0.5;  // a joint that lies there limp may be a little beyond; far beyond, it is not
                                        // that joint, or its zero is wrong [rad]
};

namespace start_check_detail {

inline std::string number(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace start_check_detail

/// A sentence without the joint's name; none where it may start.
inline std::optional<std::string> why_not_to_start(const Joint& joint, const StartState& state,
                                                   const StartCriteria& criteria = {}) {
  using start_check_detail::number;
  const AlarmOptions& alarms = criteria.alarms;
  if (state.voltage_v < alarms.low_voltage_v) {
    return "has a supply of " + number(state.voltage_v, 1) + " V, below " + number(alarms.low_voltage_v, 1) +
           " V; charge or change the battery";
  }
  if (state.voltage_v > alarms.high_voltage_v) {
    return "has a supply of " + number(state.voltage_v, 1) + " V, above the " + number(alarms.high_voltage_v, 1) +
           " V that it may get; use another supply";
  }
  if (state.temperature_celsius >= alarms.hot_celsius) {
    return "is " + number(state.temperature_celsius, 0) + " degrees C hot, and starts below " +
           number(alarms.hot_celsius, 0) + "; let it cool";
  }
  if ((state.hardware_error & ~std::uint32_t{protocol2::input_voltage_error}) != 0) {
    return "reports a hardware error (overload, heat, electrical shock or encoder); switch its power off and on, and "
           "find out why";
  }
  const double beyond = std::max(joint.min_rad - state.position_rad, state.position_rad - joint.max_rad);
  if (beyond > criteria.most_beyond_limits_rad) {
    return "is at " + number(state.position_rad, 2) + " rad, far beyond its limits of " + number(joint.min_rad, 2) +
           " and " + number(joint.max_rad, 2) + "; are two ids swapped, or is its zero wrong?";
  }
  return std::nullopt;
}

}  // namespace dynamixel
