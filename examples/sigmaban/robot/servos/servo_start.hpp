// The steps of a start: all servos heard, their settings kept, their goals where they are, their torque on; each step
// read back, and a sentence where it fails.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "../bus/bus.hpp"
#include "../bus/keep_trying.hpp"
#include "feedback.hpp"
#include "joint.hpp"
#include "servo_group_types.hpp"
#include "servo_registers.hpp"
#include "start_check.hpp"

namespace dynamixel {

/// Throws BusError, naming joint and servo.
[[noreturn]] inline void fail(const Joint& joint, const std::string& what) {
  throw BusError("joint " + joint.name + " (servo " + std::to_string(joint.id) + "): " + what);
}

namespace servo_start_detail {

inline constexpr double least_trying_s = 0.2;      // of each step: machines stand still for a moment, too [s]
inline constexpr double largest_delay_s = 508e-6;  // that a servo can have as its Return Delay Time [s]
inline constexpr double long_patience_s = 0.05;    // three periods of the worst latency timer [s]

/// Why a servo was not heard; `if_it_is` where it answers a ping.
template <class ServoBus>
std::string why_not_heard(ServoBus& bus, std::uint8_t id, const char* if_it_is) {
  if (bus.ping(id)) return if_it_is;
  bus.set_patience(largest_delay_s, long_patience_s);
  static_cast<void>(bus.ping(id));                                      // until all that is under way has come
  const Time asked = bus.port().now() + from_seconds(long_patience_s);  // a ping waits for as long a silence before
  const Reply reply = bus.ping(id);
  if (reply) {
    return "answers after " + std::to_string((bus.port().now() - asked).count() / 1'000'000) +
           " ms, too late for a walk; set the latency timer of the adapter to 1 ms (setserial PORT low_latency)";
  }
  if (reply.outcome == Outcome::corrupted || reply.outcome == Outcome::wrong_id) {
    return "answers, but in pieces; have two servos that id, or is a plug loose?";
  }
  return "does not answer; check its id, its cable and the power";
}

}  // namespace servo_start_detail

/// Listens until all were heard, for as long as `find_s` for each. Throws BusError where one was not. From then on the
/// bus waits for as long as the servos' own return delays ask for.
template <class ServoBus, class Listen, class Heard>
void find_servos(ServoBus& bus, ServoRegisters<ServoBus>& registers, const std::vector<Joint>& joints, double find_s,
                 Listen listen, Heard heard) {
  using namespace servo_start_detail;
  const BusOptions before = bus.options();
  bus.set_patience(std::max(before.return_delay_s, largest_delay_s), before.latency_s);
  const auto missing = [&] {
    std::size_t i = 0;
    while (i < joints.size() && heard(i)) ++i;
    return i;
  };
  const bool found = keep_trying(bus, find_s, [&] {
    listen();
    return missing() == joints.size();
  });
  if (!found) {
    const Joint& joint = joints[missing()];
    const std::string why =
        why_not_heard(bus, joint.id, "answers a ping but no question; its Status Return Level is 0, set it to 2");
    bus.set_patience(before.return_delay_s, before.latency_s);
    fail(joint, why);
  }
  double longest = 0;  // return delay [s]
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto counts = registers.read(i, "return_delay_time");
    longest = std::max(longest, counts ? *counts * return_delay_s : largest_delay_s);
  }
  bus.set_patience(longest, before.latency_s);
}

/// Keeps its settings and measures its supply. Throws BusError where the servo does not tell, or should not start.
template <class ServoBus>
void check_before_start(ServoBus& bus, ServoRegisters<ServoBus>& registers, const Feedback& supply, const Joint& joint,
                        std::size_t i, const StartCriteria& criteria, JointState& state) {
  using namespace servo_start_detail;
  std::array<std::uint8_t, 16> bytes{};
  const Buffer read = Buffer(bytes).first(supply.count());
  std::optional<HealthAnswer> health;
  const bool told = keep_trying(bus, least_trying_s, [&] {
    if (!registers.keep_settings(i) || !bus.read(joint.id, supply.address(), read)) return false;
    health = registers.read_health(i);
    return health.has_value();
  });
  if (!told) {
    fail(joint, why_not_heard(bus, joint.id,
                              "answers too seldom to be trusted with a robot; check its cable, the power and the speed "
                              "of the bus"));
  }
  const ServoState servo = supply.parse(read);
  state.voltage_v = servo.voltage_v;
  state.temperature_celsius = servo.temperature_celsius;
  const StartState measured{state.position_rad, servo.voltage_v, servo.temperature_celsius, health->hardware_error};
  if (const auto why = why_not_to_start(joint, measured, criteria)) fail(joint, *why);
}

/// Goals first, which send_goals() sends, then the torque, then the servos' own watchdogs. Throws BusError where a
/// servo does not take one of them.
template <class ServoBus, class SendGoals>
void switch_torque_on(const ServoBus& bus, ServoRegisters<ServoBus>& registers, const std::vector<Joint>& joints,
                      SendGoals send_goals, const std::vector<std::uint32_t>& goals) {
  using namespace servo_start_detail;
  const auto until_all = [&](auto write, auto done, const char* what) {
    std::vector<char> right(joints.size());
    std::size_t open = joints.size();
    keep_trying(bus, least_trying_s, [&] {
      send_goals();
      for (std::size_t i = 0; i < joints.size(); ++i) {
        if (!right[i]) write(i);
      }
      for (std::size_t i = 0; i < joints.size(); ++i) {
        if (!right[i] && done(i)) right[i] = true, --open;
      }
      return open == 0;
    });
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (!right[i]) fail(joints[i], what);
    }
  };
  until_all([&](std::size_t i) { registers.write_one(i, "bus_watchdog", 0); },
            [&](std::size_t i) { return registers.read(i, "goal_position") == goals[i]; },
            "does not take its goal; see its limits and its operating mode");
  until_all([&](std::size_t i) { registers.write_one(i, "torque_enable", 1); },
            [&](std::size_t i) { return registers.read(i, "torque_enable") == 1U; },
            "does not switch its torque on; switch its power off and on");
  if (!registers.has_watchdog()) return;
  until_all([&](std::size_t i) { registers.write_one(i, "bus_watchdog", registers.watchdog()); },
            [&](std::size_t i) { return registers.read(i, "bus_watchdog") == registers.watchdog(); },
            "does not take its Bus Watchdog; update its firmware, or go without (surefoot-walk --bus-watchdog 0)");
}

}  // namespace dynamixel
