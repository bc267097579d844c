// What the twin is made of: a humanoid of 60 cm and 4.2 kg with two legs of six servos, to be simulated by MuJoCo.
//
// Frames of links: origin on the joint axes of the link (of the trunk: between the hips), x forward, y left, z up when
// the robot stands straight.
#pragma once

#include <array>

#include "../robot/virtual_bus/servo_motor.hpp"
#include "../robot/walk_engine/walk_parameters.hpp"

namespace sigmaban {

/// A rigid part, as heavy as a solid box.
struct TwinLink {
  double mass = 0;                           // [kg]
  std::array<double, 3> centre = {0, 0, 0};  // of the box, in the frame of the link [m]
  std::array<double, 3> size = {0, 0, 0};    // edges of the box [m]
};

/// An MX-64 under voltage-driven proportional control:
/// torque = limit to +-torque_limit (stiffness (target - position)) - damping velocity - dry friction.
struct TwinServo {
  double stiffness = dynamixel::MotorParameters().stiffness;        // at the nominal voltage [N m/rad]
  double torque_limit = 4.74;                                       // at the nominal voltage [N m]
  double damping = dynamixel::MotorParameters().damping;            // mostly back-EMF [N m s/rad]
  double dry_friction = dynamixel::MotorParameters().dry_friction;  // [N m]
  double armature = dynamixel::MotorParameters().inertia;           // of motor and gears, at the joint [kg m^2]
  double voltage = dynamixel::MotorParameters().stiffness_voltage;  // nominal [V]
};

/// Four spherical cleats under each foot.
struct TwinCleats {
  double radius = 0.006;   // [m]
  double x = 0.060;        // ahead of and behind the ankle [m]
  double y = 0.034;        // to either side of their middle [m]
  double outward = 0.005;  // of their middle from the ankle [m]
};

/// Of cleats with the ground.
struct TwinContact {
  double friction = 0.9;             // sliding [1]
  double torsional_friction = 4e-3;  // [m]
  double rolling_friction = 2e-4;    // [m]
  double time_constant = 0.008;      // of the penetration's decay, critically damped [s]
};

struct TwinParameters {
  LegLengths leg;
  double feet_distance = 0.092;  // between the hips, sideways [m]

  TwinLink upper_body{2.30, {0, 0, 0.13}, {0.10, 0.25, 0.36}};  // with arms and head
  TwinLink hip_yaw{0.04, {0, 0, 0}, {0.04, 0.04, 0.04}};
  TwinLink hip_block{0.26, {0, 0, 0}, {0.06, 0.05, 0.06}};
  TwinLink thigh{0.15, {0, 0, -0.0465}, {0.05, 0.05, 0.093}};
  TwinLink shin{0.06, {0, 0, -0.0525}, {0.04, 0.05, 0.105}};
  TwinLink ankle_block{0.26, {0, 0, 0}, {0.06, 0.05, 0.06}};
  TwinLink foot{0.18, {0, 0, -0.021}, {0.14, 0.08, 0.010}};

  TwinServo servo;
  TwinCleats cleats;
  TwinContact contact;
  double gravity = 9.81;       // [m/s^2]
  double time_step = 0.001;    // of the physics [s]
  double order_period = 0.01;  // between joint targets [s], a multiple of the time step
};

/// How the twin walks: the gait of RoboCup 2015, further back and lower over its feet.
inline WalkParameters twin_walk() {
  WalkParameters walk;
  walk.trunk_x_offset = 0.01;
  walk.trunk_z_offset = 0.03;
  return walk;
}

}  // namespace sigmaban
