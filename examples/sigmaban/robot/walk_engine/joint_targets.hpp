// The twelve joint angles that a walk engine asks for. Zero is all joints straight.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

namespace sigmaban {

/// Of one leg, from the trunk down [rad]. From the hip, a foot's frame is turned by
/// RotZ(hip_yaw) RotX(hip_roll) RotY(hip_pitch + knee + ankle_pitch) RotX(ankle_roll); x forward, y left, z up.
struct LegJoints {
  double hip_yaw = 0;
  double hip_pitch = 0;
  double hip_roll = 0;
  double knee = 0;
  double ankle_pitch = 0;
  double ankle_roll = 0;
};

inline constexpr std::array<std::string_view, 12> joint_names{
    "left_hip_yaw",  "left_hip_pitch",  "left_hip_roll",  "left_knee",  "left_ankle_pitch",  "left_ankle_roll",
    "right_hip_yaw", "right_hip_pitch", "right_hip_roll", "right_knee", "right_ankle_pitch", "right_ankle_roll"};

struct JointTargets {
  LegJoints left, right;

  /// In the order of joint_names [rad].
  constexpr std::array<double, 12> array() const {
    return {left.hip_yaw,  left.hip_pitch,  left.hip_roll,  left.knee,  left.ankle_pitch,  left.ankle_roll,
            right.hip_yaw, right.hip_pitch, right.hip_roll, right.knee, right.ankle_pitch, right.ankle_roll};
  }
};

inline bool all_finite(const JointTargets& targets) {
  for (const double angle : targets.array()) {
    if (!std::isfinite(angle)) return false;
  }
  return true;
}

}  // namespace sigmaban
