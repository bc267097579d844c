// What shapes a walk, apart from the orders. The defaults are those of the RoboCup 2015 robot.
//
// Trunk frame: x forward, y left, z up. Times are shares of the walk cycle (two steps), in [0,1].
#pragma once

#include <cmath>

namespace sigmaban {

/// Between the axes of a leg, straight down [m].
struct LegLengths {
  double hip_to_knee = 0.093;
  double knee_to_ankle = 0.105;
  double ankle_to_ground = 0.032;

  constexpr double sum() const { return hip_to_knee + knee_to_ankle + ankle_to_ground; }
};

/// Added to where one foot would be, before the trunk leans.
struct FootOffset {
  double x = 0, y = 0, z = 0;           // [m]
  double yaw = 0, pitch = 0, roll = 0;  // [rad]
};

struct WalkParameters {
  LegLengths leg;
  double feet_distance = 0.092;  // between the feet of straight legs, sideways [m]

  double frequency = 1.7;          // walk cycles per second [Hz]
  double support_phase_ratio = 0;  // share of the cycle with both feet on the ground, 0 to 1
  double foot_y_offset = 0.025;    // each foot outwards [m]
  double rise = 0.035;             // of a foot in the air [m]
  double swing = 0.02;             // of the trunk to each side [m]
  double swing_roll = 0;           // of the trunk to each side [rad]
  double swing_phase = 0.25;       // by which the swing is ahead of the steps
  double swing_pause = 0;          // share of the cycle the trunk stays at one side, 0 to 0.5
  double swing_velocity = 4;       // slope of the swing [1/cycle], as are the next four
  double step_up_velocity = 4;     // forwards, when a foot leaves the ground
  double step_down_velocity = 4;   // backwards, when it touches the ground
  double rise_up_velocity = 4;     // upwards, when it leaves the ground
  double rise_down_velocity = 4;   // downwards, when it touches the ground
  double trunk_x_offset = 0.02;    // of the trunk before the feet [m]
  double trunk_y_offset = 0;       // of the trunk to the left of the feet [m]
  double trunk_z_offset = 0.02;    // of the trunk below straight legs [m]
  double trunk_pitch = 0.15;       // > 0 leans forwards [rad]
  double trunk_roll = 0;           // > 0 leans to the right [rad]
  FootOffset extra_left, extra_right;
};

/// Whether an engine can walk by them: all finite, lengths positive, shares of the cycle in their ranges.
inline bool usable(const WalkParameters& p) {
  const auto finite = [](auto... values) { return (std::isfinite(values) && ...); };
  const auto finite_offset = [&](const FootOffset& f) { return finite(f.x, f.y, f.z, f.yaw, f.pitch, f.roll); };
  return finite(p.leg.hip_to_knee, p.leg.knee_to_ankle, p.leg.ankle_to_ground, p.feet_distance, p.frequency,
                p.support_phase_ratio, p.foot_y_offset, p.rise, p.swing, p.swing_roll, p.swing_phase, p.swing_pause,
                p.swing_velocity, p.step_up_velocity, p.step_down_velocity, p.rise_up_velocity, p.rise_down_velocity,
                p.trunk_x_offset, p.trunk_y_offset, p.trunk_z_offset, p.trunk_pitch, p.trunk_roll) &&
         finite_offset(p.extra_left) && finite_offset(p.extra_right) &&  //
         p.leg.hip_to_knee > 0 && p.leg.knee_to_ankle > 0 && p.leg.ankle_to_ground >= 0 && p.support_phase_ratio >= 0 &&
         p.support_phase_ratio <= 1 && p.swing_pause >= 0 && p.swing_pause <= 0.5;
}

}  // namespace sigmaban
