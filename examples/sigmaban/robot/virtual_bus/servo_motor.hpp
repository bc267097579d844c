// The motor of an MX-64 with its gears: a voltage in proportion to the position error, and what resists.
#pragma once

#include <algorithm>
#include <cmath>

namespace dynamixel {

struct MotorParameters {
  double torque_constant = 1.62;    // behind the gears [N m/A], which is also the back-EMF [V s/rad]
  double resistance_ohm = 3.95;     // [ohm]
  double stiffness = 24.0;          // with that gain at that voltage [N m/rad]
  double stiffness_p_gain = 32.0;   // counts of Protocol 1.0
  double stiffness_voltage = 12.0;  // [V]
  double damping = 0.676;           // while driven, mostly by back-EMF [N m s/rad]
  double dry_friction = 0.09;       // [N m]
  double inertia = 0.012;           // of rotor and gears, behind the gears [kg m^2]
};

struct MotorState {
  double position_rad = 0;
  double velocity_rad_per_s = 0;
  double current_a = 0;
};

struct MotorInputs {
  bool torque_on = false;
  double goal_rad = 0;
  double p_gain = 32;
  double voltage_v = 12;
  double load_nm = 0;          // torque of what hangs on the shaft [N m]
  double load_inertia = 0;     // [kg m^2]
  double largest_voltage = 1;  // share of the voltage that the driver may use
};

/// The share of the voltage that the controller applies, in [-largest, largest].
inline double duty(const MotorParameters& motor, const MotorState& state, const MotorInputs& inputs) {
  const double full_torque = motor.torque_constant * motor.stiffness_voltage / motor.resistance_ohm;
  const double per_rad = motor.stiffness / full_torque * inputs.p_gain / motor.stiffness_p_gain;
  return std::clamp(per_rad * (inputs.goal_rad - state.position_rad), -inputs.largest_voltage, inputs.largest_voltage);
}

/// `dt` later [s], at most some milliseconds. Semi-implicit: damping acts on the new velocity. Dry friction takes all
/// of a step's momentum where it can (the shaft then sticks), else its full share.
inline MotorState step(const MotorParameters& motor, const MotorState& state, const MotorInputs& inputs, double dt) {
  const double back_emf_damping = motor.torque_constant * motor.torque_constant / motor.resistance_ohm;
  const double damping = inputs.torque_on ? motor.damping : std::max(0.0, motor.damping - back_emf_damping);
  const double volts = inputs.torque_on ? duty(motor, state, inputs) * inputs.voltage_v : 0.0;
  const double torque = motor.torque_constant / motor.resistance_ohm * volts + inputs.load_nm;
  const double inertia = motor.inertia + inputs.load_inertia;

  const double momentum = inertia * state.velocity_rad_per_s + dt * torque;
  const double friction = dt * motor.dry_friction;
  const double left = std::abs(momentum) <= friction ? 0.0 : momentum - std::copysign(friction, momentum);
  MotorState next;
  next.velocity_rad_per_s = left / (inertia + dt * damping);
  next.position_rad = state.position_rad + dt * next.velocity_rad_per_s;
  if (inputs.torque_on) {
    next.current_a = (volts - motor.torque_constant * next.velocity_rad_per_s) / motor.resistance_ohm;
  }
  return next;
}

}  // namespace dynamixel
