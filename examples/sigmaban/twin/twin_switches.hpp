// Physics that simulators tend to leave out, each as one number that is 0 while it is off.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <string_view>

#include "../robot/walk_engine/joint_targets.hpp"
#include "surefoot/core/error.hpp"

namespace sigmaban {

/// Parameters, switches or commands that the twin cannot take, or a physics engine that fails.
struct TwinError : surefoot::Error {
  using Error::Error;
};

struct TwinSwitches {
  double backlash = 0;         // free play behind every servo, from end to end [rad]
  double servo_friction = 0;   // further dry friction of every servo [N m]
  double joint_zero = 0;       // by which the zero of every servo has moved [rad]
  double order_delay = 0;      // walk commands take effect so much later, a whole number [cycles]
  double slope_forward = 0;    // the ground falls in the direction that the robot looks in at the start [rad]
  double slope_left = 0;       // the ground falls to the left of that direction [rad]
  double short_left_leg = 0;   // by how much the left shin is shorter [m]
  double battery_drop = 0;     // below the nominal voltage: stiffness and torque limit fall in proportion [V]
  double soft_ground = 0;      // by which the ground gives way more slowly: time constant of its contacts [s]
  double slippery_radius = 0;  // of a slippery disc on the ground, its centre 0.4 m ahead of the start [m]
  int joint = -1;  // in the order of joint_names: the only one with backlash, servo_friction, joint_zero; or -1

  bool at(std::size_t which) const { return joint < 0 || which == static_cast<std::size_t>(joint); }
};

/// Name and unit of a switch, what it is if nothing is said (`usual`), and its largest value; its smallest is the
/// negative of it for those that have two sides, else 0. One of joints may be that of a single one.
struct TwinSwitch {
  std::string_view name, unit;
  double usual = 0, largest = 0;
  bool two_sided = false;
  double TwinSwitches::*member = nullptr;
  bool of_joints = false;
};

inline constexpr std::array<TwinSwitch, 10> twin_switches{{
    {"backlash", "rad", 0.012, 0.1, false, &TwinSwitches::backlash, true},
    {"servo_friction", "N m", 0.15, 2, false, &TwinSwitches::servo_friction, true},
    {"joint_zero", "rad", 0.03, 0.3, true, &TwinSwitches::joint_zero, true},
    {"order_delay", "cycles", 1, 20, false, &TwinSwitches::order_delay},
    {"slope_forward", "rad", 0.02, 0.3, true, &TwinSwitches::slope_forward},
    {"slope_left", "rad", 0.02, 0.3, true, &TwinSwitches::slope_left},
    {"short_left_leg", "m", 0.002, 0.05, true, &TwinSwitches::short_left_leg},
    {"battery_drop", "V", 2, 11, false, &TwinSwitches::battery_drop},
    {"soft_ground", "s", 0.03, 0.2, false, &TwinSwitches::soft_ground},
    {"slippery_radius", "m", 0.3, 100, false, &TwinSwitches::slippery_radius},
}};

inline constexpr double slippery_centre = 0.4;    // ahead of the start [m]
inline constexpr double slippery_friction = 0.3;  // sliding, on the slippery disc [1]

/// Throws TwinError naming the switch that is out of its range.
inline void check(const TwinSwitches& switches) {
  for (const TwinSwitch& s : twin_switches) {
    const double value = switches.*s.member, smallest = s.two_sided ? -s.largest : 0;
    std::ostringstream text;
    text << "switch " << s.name << ": must be a number from " << smallest << " to " << s.largest << ' ' << s.unit
         << ", got " << value;
    if (!(value >= smallest && value <= s.largest)) throw TwinError(text.str());
  }
  if (switches.order_delay != std::floor(switches.order_delay)) {
    throw TwinError("switch order_delay: must be a whole number of cycles, got " +
                    std::to_string(switches.order_delay));
  }
}

/// Of all joints' switches there is one joint, or all.
inline void choose_joint(TwinSwitches& switches, const TwinSwitch& s, std::string_view name) {
  const auto found = std::ranges::find(joint_names, name);
  if (!s.of_joints || found == joint_names.end()) {
    throw TwinError("switch " + std::string(s.name) + ": it has no joint " + std::string(name));
  }
  const auto joint = static_cast<int>(found - joint_names.begin());
  if (switches.joint >= 0 && switches.joint != joint) throw TwinError("switches of two joints: give one joint alone");
  switches.joint = joint;
}

/// Sets one switch from "name" (its usual value) or "name=value"; "name:joint" is that joint's alone. Throws TwinError
/// for others.
inline void set_switch(TwinSwitches& switches, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view named = text.substr(0, equals), name = named.substr(0, named.find(':'));
  std::string known;
  for (const TwinSwitch& s : twin_switches) {
    known += (known.empty() ? "" : ", ") + std::string(s.name);
    if (name != s.name) continue;
    if (name.size() < named.size()) choose_joint(switches, s, named.substr(name.size() + 1));
    switches.*s.member = s.usual;
    if (equals != std::string_view::npos) {
      std::istringstream number{std::string(text.substr(equals + 1))};
      number.imbue(std::locale::classic());
      if (!(number >> switches.*s.member) || number.peek() != std::istringstream::traits_type::eof()) {
        throw TwinError("switch " + std::string(text) + ": a number was expected after the =, in " +
                        std::string(s.unit));
      }
    }
    return check(switches);
  }
  throw TwinError("switch " + std::string(name) + ": there is no such switch; there are " + known);
}

}  // namespace sigmaban
