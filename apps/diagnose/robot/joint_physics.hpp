// What a joint, its drive and its link may have that a rigid-body model leaves out; one number each.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace diagnose_robot {

enum class Property : unsigned char {
  coulomb,          // dry friction [N m]
  viscous,          // [N m s/rad]
  breakaway,        // dry friction at rest beyond `coulomb`, gone at a few times `stribeck_speed` [N m]
  load_friction,    // dry friction per torque of the drive [1]
  drag,             // [N m s^2/rad^2]
  armature,         // inertia of the rotor, seen at the joint [kg m^2]
  kp_error,         // relative, of a position drive [1]
  kd_error,         // relative, of a position drive [1]
  torque_gain,      // relative, of all torque that a position drive gives [1]
  reading_scale,    // relative, of the recorded torque of a torque drive: 0.25 reads a quarter more than there is [1]
  reading_age,      // of the angles and speeds that a position drive acts on [s]
  speed_age,        // the same of the speeds alone, beyond that [s]
  goal_clock,       // by which goals act later than they are logged, less than any delay that is named [s]
  torque_limit,     // share of the stated limit that is missing [1]
  lag,              // time constant of the torque [s]
  delay,            // of what the drive is told, goal or torque [s]
  backlash,         // half width, between what the drive sees and the joint [rad]
  constant_torque,  // [N m]
  stiffness,        // of a spring, or of cables, beyond what the file has, with the same rest [N m/rad]
  sensor_bias,      // of the measured angle [rad]
  link_mass,        // relative, mass and inertia of the link that the joint moves [1]
  link_com_x,       // shift of its centre of mass in the frame of the link [m]
  link_com_y,
  link_com_z,
  link_inertia,   // relative, inertia about the centre of mass alone: never searched, see uncertain_bodies.hpp [1]
  payload,        // point mass at the tip of the link [kg]
  pair_coulomb,   // on the sum of the speeds of this joint and the one before it [N m]
  pair_viscous,   // the same [N m s/rad]
  pair_armature,  // the same [kg m^2]
  count
};

inline constexpr std::size_t property_count = static_cast<std::size_t>(Property::count);
inline constexpr double stribeck_speed = 0.1;  // [rad/s], at which breakaway has fallen to 37 %

/// All properties of one joint; zero is the rigid body with the drive as stated.
struct JointPhysics {
  std::array<double, property_count> value{};

  double& operator[](Property p) { return value[static_cast<std::size_t>(p)]; }
  double operator[](Property p) const { return value[static_cast<std::size_t>(p)]; }
};

using RobotPhysics = std::vector<JointPhysics>;  // by joint

/// How a property is named, bounded and searched.
struct PropertyInfo {
  Property property;
  const char* effect;  // as in the catalogue of effects, where it is there
  const char* parameter;
  const char* unit;
  const char* of_group;               // sentence: "dry friction"
  double low, high;                   // bounds, in units of `typical`
  bool position_drive, torque_drive;  // where it is considered
  bool calibration;                   // a number that the setup states, rather than physics that it leaves out
};

const std::array<PropertyInfo, property_count>& property_table();
inline const PropertyInfo& info_of(Property p) { return property_table()[static_cast<std::size_t>(p)]; }

inline double sign_of(double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }

/// Mass, centre of mass or payload of a link.
inline bool is_of_body(Property p) { return p >= Property::link_mass && p <= Property::payload; }

/// How drives and logs keep time: fitted, as all of them must, and never named.
inline bool is_of_timing(Property p) { return p >= Property::reading_age && p <= Property::goal_clock; }

/// On the sum of the speeds of two joints.
inline bool is_of_pair(Property p) { return p >= Property::pair_coulomb && p <= Property::pair_armature; }

/// Of rotor, drive and link of one joint, from which typical sizes of properties follow.
struct JointScale {
  double torque = 1, speed = 1, acceleration = 1, angle = 1;  // root mean squares over the recordings
  double reading = 1;      // root mean square of the recorded torque, on its own scale
  double link_size = 0.1;  // [m]
  double link_mass = 1;    // [kg]
  double offset = 0.05;    // [rad] by which encoders are mounted or zeroed wrongly
  double row = 0.005;      // [s] between two rows
};

/// A recording says no more about time than when in its rows something was read or told.
inline constexpr double row_share = 0.25;

/// A size that the property might well have at this joint: bounds and steps of finite differences are measured in it.
double typical_size(Property property, const JointScale& scale);

}  // namespace diagnose_robot
