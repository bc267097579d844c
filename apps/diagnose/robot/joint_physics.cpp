#include "joint_physics.hpp"

#include <algorithm>

namespace diagnose_robot {

const std::array<PropertyInfo, property_count>& property_table() {
  using enum Property;
  static const std::array<PropertyInfo, property_count> table{{
      {coulomb, "coulomb_friction", "level", "N m", "dry friction", 0, 40, true, true, false},
      {viscous, "viscous_friction", "damping", "N m s/rad", "friction that grows with speed", 0, 40, true, true, false},
      {breakaway, "stribeck_friction", "breakaway", "N m", "more dry friction at rest", 0, 20, true, true, false},
      {load_friction, "load_dependent_friction", "factor", "1", "dry friction in proportion to the torque of the drive",
       0, 9, true, true, false},
      {drag, "quadratic_drag", "drag", "N m s^2/rad^2", "drag that grows with the square of speed", 0, 40, true, true,
       false},
      {armature, "rotor_inertia", "armature", "kg m^2", "inertia of the rotor", 0, 40, true, true, false},
      {kp_error, "drive_gain", "kp_error", "1", "proportional gain other than stated", -9, 20, true, false, true},
      // Only less than stated: more of it is friction that grows with speed, and no recording tells them apart.
      {kd_error, "drive_damping_gain", "kd_error", "1", "derivative gain below the stated one", -10, 0, true, false,
       true},
      {torque_gain, "input_gain", "gain_error", "1", "torque other than the drive is told", -9, 20, true, false, false},
      {reading_scale, "sensor_scale", "scale_error", "1", "recorded torque on another scale, or of the other sign", -20,
       100, false, true, true},
      // Half of a period of its loop, over which torque is held, and the time it takes to read and compute.
      {reading_age, "drive_sampling", "age", "s", "readings that are old when the drive acts on them", 0, 4, true,
       false, false},
      // Differences of angles are half a period old.
      {speed_age, "drive_sampling", "speed_age", "s", "speeds that are older than angles", 0, 4, true, false, false},
      {goal_clock, "drive_sampling", "goal_clock", "s", "goals that act later than they are logged", -1, 1, true, false,
       false},
      {torque_limit, "saturation", "missing_share", "1", "torque limit below the stated one", 0, 9.9, true, false,
       false},
      {lag, "first_order_lag", "time_constant", "s", "torque that lags", 0, 30, true, false, false},
      {delay, "input_delay", "delay", "s", "commands that arrive late", 0, 40, true, true, false},
      {backlash, "backlash", "half_width", "rad", "backlash", 0, 40, true, false, false},
      {constant_torque, "constant_force", "torque", "N m", "constant torque", -20, 20, true, true, false},
      {stiffness, "joint_spring", "stiffness", "N m/rad", "a spring", 0, 40, true, true, false},
      {sensor_bias, "sensor_bias", "bias", "rad", "offset of the encoder", -10, 10, true, true, false},
      {link_mass, "link_mass", "mass_error", "1", "mass of the link other than stated", -8, 30, true, true, true},
      {link_com_x, "link_com", "shift_x", "m", "centre of mass of the link elsewhere", -10, 10, true, true, true},
      {link_com_y, "link_com", "shift_y", "m", "centre of mass of the link elsewhere", -10, 10, true, true, true},
      {link_com_z, "link_com", "shift_z", "m", "centre of mass of the link elsewhere", -10, 10, true, true, true},
      {link_inertia, "link_inertia", "inertia_error", "1", "inertia of the link other than stated", -8, 30, false,
       false, true},
      {payload, "payload", "mass", "kg", "payload at the tip", 0, 50, true, true, true},
      {pair_coulomb, "coupled_coulomb_friction", "level", "N m", "dry friction on the sum of two speeds", 0, 40, false,
       true, false},
      {pair_viscous, "coupled_viscous_friction", "damping", "N m s/rad", "friction on the sum of two speeds", 0, 40,
       false, true, false},
      {pair_armature, "coupled_rotor_inertia", "armature", "kg m^2", "rotor inertia on the sum of two speeds", 0, 40,
       false, true, false},
  }};
  return table;
}

double typical_size(Property property, const JointScale& scale) {
  constexpr double share = 0.1;         // of the torque of the drive: what friction or inertia easily takes
  constexpr double relative = 0.1;      // error of a gain or a mass
  constexpr double time = 0.005;        // [s] of a bus or a filter
  constexpr double loop = 0.0005;       // [s]: half a period of a drive's loop at 1 kHz
  constexpr double angle_share = 0.02;  // of the angle: backlash
  switch (property) {
    case Property::viscous:
    case Property::pair_viscous:
      return share * scale.torque / scale.speed;
    case Property::drag:
      return share * scale.torque / (scale.speed * scale.speed);
    case Property::armature:
    case Property::pair_armature:
      return share * scale.torque / scale.acceleration;
    case Property::kp_error:
    case Property::kd_error:
    case Property::torque_gain:
    case Property::reading_scale:
    case Property::torque_limit:
    case Property::load_friction:
    case Property::link_mass:
    case Property::link_inertia:
      return relative;
    case Property::lag:
    case Property::delay:
      return time;
    case Property::reading_age:
    case Property::speed_age:
      return loop;
    case Property::goal_clock:
      return row_share * scale.row;
    case Property::stiffness:
      return share * scale.torque / scale.angle;
    case Property::backlash:
      return angle_share * scale.angle;
    case Property::sensor_bias:
      return scale.offset;
    case Property::link_com_x:
    case Property::link_com_y:
    case Property::link_com_z:
      return relative * scale.link_size;
    case Property::payload:
      return relative * scale.link_mass;
    default:
      return share * scale.torque;
  }
}

}  // namespace diagnose_robot
