// A joint of the robot and the servo that moves it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "../bus/transport.hpp"
#include "../dynamixel/control_tables.hpp"

namespace dynamixel {

struct Joint {
  std::string name;
  std::uint8_t id = 1;    // of its servo
  double zero_rad = 0;    // the servo's angle where the joint's is 0; the servo's is 0 at the centre of its turn [rad]
  int sign = 1;           // -1: joint and servo turn in opposite directions
  double min_rad = -2.6;  // of the joint; both limits must be within the servo's one turn [rad]
  double max_rad = 2.6;
};

inline double servo_angle(const Joint& joint, double joint_rad) { return joint.zero_rad + joint.sign * joint_rad; }
inline double joint_angle(const Joint& joint, double servo_rad) { return joint.sign * (servo_rad - joint.zero_rad); }

/// Throws BusError, naming the joint and what is wrong with it. `model` is that of the servos.
inline void check_joints(std::span<const Joint> joints, std::size_t most, const ServoModel& model = mx_64_protocol_2) {
  const auto fail = [](const Joint& joint, const std::string& what) {
    throw BusError("joint " + joint.name + ": " + what);
  };
  if (joints.empty()) throw BusError("joints: there are none; give at least one");
  if (joints.size() > most) throw BusError("joints: there are more than " + std::to_string(most) + "; use two groups");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    if (joint.sign != 1 && joint.sign != -1) fail(joint, "its sign must be 1 or -1");
    if (!(joint.min_rad < joint.max_rad)) fail(joint, "its lower limit must be below its upper one");
    for (const double limit : {joint.min_rad, joint.max_rad}) {
      if (!ticks_of(model, servo_angle(joint, limit))) {
        fail(joint, "its limit " + std::to_string(limit) + " rad is beyond the servo's turn; mind its zero");
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (joints[j].id == joint.id) fail(joint, "has the servo id of " + joints[j].name);
      if (joints[j].name == joint.name) fail(joint, "there are two of that name");
    }
  }
}

}  // namespace dynamixel
