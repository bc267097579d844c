// Options and states of a group of servos.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../bus/transport.hpp"
#include "alarms.hpp"
#include "feedback.hpp"
#include "presence.hpp"
#include "servo_care.hpp"
#include "servo_events.hpp"
#include "start_check.hpp"

namespace dynamixel {

class TorqueGuard;

enum class BeyondLimits : std::uint8_t { clamp, refuse };

struct ServoGroupOptions {
  double soft_start_s = 2.0;          // from the measured to the wanted angles [s]
  double watchdog_s = 0.25;           // without goals, after which the torque goes off [s]
  double bus_watchdog_s = 0.5;        // without any instruction, after which servos of Protocol 2.0 stop; 0: never [s]
  double listen_s = 0.008;            // that reading all joints may take at most in a cycle [s]
  double find_s = 0.5;                // that each servo has to be heard for the first time [s]
  std::vector<double> sitting_rad{};  // of the joints, from where the torque may go off; none: it does so from anywhere
  double sit_s = 1.2;                 // for the way there [s]
  BeyondLimits beyond_limits = BeyondLimits::clamp;         // refuse: the joint keeps its goal
  FeedbackKind feedback = FeedbackKind::motion_and_health;  // of each cycle; motion alone where that takes too long
  PresenceOptions presence{};
  AlarmOptions alarms{};
  double most_beyond_limits_rad = 0.5;  // where a joint may be at the start; see StartCriteria [rad]
  CareOptions care{};
  TorqueGuard* guard = nullptr;  // switches the torque off where this program cannot; must outlive the group
};

struct JointState {
  double position_rad = 0;  // of the joint
  double velocity_rad_per_s = 0;
  double current_a = std::numeric_limits<double>::quiet_NaN();  // where it is read, with the sign of the joint
  double voltage_v = 0;                                         // as last read
  double temperature_celsius = 0;                               // as last read
  Time measured{};                                              // when it was received
  bool fresh = false;                                           // in the last update()
  bool silent = false;
  Alarms alarms{};
  std::uint64_t goals_beyond_limits = 0;  // clamped or refused
  int implausible = 0;                    // answers in a row that no motion explains
};

}  // namespace dynamixel
