// The names of everything that shapes a walk, as in the columns of a file: `freq_hz`, `trunk_pitch_rad`, `step_m`.
#pragma once

#include <array>
#include <string_view>

#include "walk_engine.hpp"
#include "walk_parameters.hpp"

namespace sigmaban {

/// Parameters and orders together.
struct WalkSettings {
  WalkParameters parameters;
  WalkOrders orders;
};

/// The name without its unit: `_m`, `_rad`, `_hz`, and `_gain`, which may stand before the unit, are dropped.
constexpr std::string_view without_unit(std::string_view name) {
  for (const std::string_view ending : {"_m", "_rad", "_hz", "_gain"}) {
    if (name.size() > ending.size() && name.ends_with(ending)) name.remove_suffix(ending.size());
  }
  return name;
}

/// The number that a name, with or without its unit, stands for; null if there is none of that name.
inline double* find_setting(WalkSettings& settings, std::string_view name) {
  struct Entry {
    std::string_view name;
    double* value;
  };
  WalkParameters& p = settings.parameters;
  FootOffset &left = p.extra_left, &right = p.extra_right;
  const std::array entries{Entry{"step", &settings.orders.forward},
                           Entry{"lateral", &settings.orders.left},
                           Entry{"turn", &settings.orders.turn},
                           Entry{"enabled", &settings.orders.enabled},
                           Entry{"hip_knee", &p.leg.hip_to_knee},
                           Entry{"hip_to_knee", &p.leg.hip_to_knee},
                           Entry{"dist_hip_to_knee", &p.leg.hip_to_knee},
                           Entry{"knee_ankle", &p.leg.knee_to_ankle},
                           Entry{"knee_to_ankle", &p.leg.knee_to_ankle},
                           Entry{"dist_knee_to_ankle", &p.leg.knee_to_ankle},
                           Entry{"ankle_ground", &p.leg.ankle_to_ground},
                           Entry{"ankle_to_ground", &p.leg.ankle_to_ground},
                           Entry{"dist_ankle_to_ground", &p.leg.ankle_to_ground},
                           Entry{"feet_distance", &p.feet_distance},
                           Entry{"feet_lateral", &p.feet_distance},
                           Entry{"feet_lateral_distance", &p.feet_distance},
                           Entry{"dist_feet_lateral", &p.feet_distance},
                           Entry{"freq", &p.frequency},
                           Entry{"frequency", &p.frequency},
                           Entry{"support_phase_ratio", &p.support_phase_ratio},
                           Entry{"foot_y_offset", &p.foot_y_offset},
                           Entry{"rise", &p.rise},
                           Entry{"swing", &p.swing},
                           Entry{"swing_roll", &p.swing_roll},
                           Entry{"swing_phase", &p.swing_phase},
                           Entry{"swing_pause", &p.swing_pause},
                           Entry{"swing_vel", &p.swing_velocity},
                           Entry{"step_up_vel", &p.step_up_velocity},
                           Entry{"step_down_vel", &p.step_down_velocity},
                           Entry{"rise_up_vel", &p.rise_up_velocity},
                           Entry{"rise_down_vel", &p.rise_down_velocity},
                           Entry{"trunk_x_offset", &p.trunk_x_offset},
                           Entry{"trunk_y_offset", &p.trunk_y_offset},
                           Entry{"trunk_z_offset", &p.trunk_z_offset},
                           Entry{"trunk_pitch", &p.trunk_pitch},
                           Entry{"trunk_roll", &p.trunk_roll},
                           Entry{"extra_left_x", &left.x},
                           Entry{"extra_left_y", &left.y},
                           Entry{"extra_left_z", &left.z},
                           Entry{"extra_left_yaw", &left.yaw},
                           Entry{"extra_left_pitch", &left.pitch},
                           Entry{"extra_left_roll", &left.roll},
                           Entry{"extra_right_x", &right.x},
                           Entry{"extra_right_y", &right.y},
                           Entry{"extra_right_z", &right.z},
                           Entry{"extra_right_yaw", &right.yaw},
                           Entry{"extra_right_pitch", &right.pitch},
                           Entry{"extra_right_roll", &right.roll}};
  for (const Entry& entry : entries) {
    if (entry.name == name || entry.name == without_unit(name)) return entry.value;
  }
  return nullptr;
}

}  // namespace sigmaban
