// Formulas of the forces on a machine with one degree of freedom.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plant.hpp"

namespace plants {

/// The machine in one moment.
struct Motion {
  double time = 0;      // [s]
  double position = 0;  // [rad] or [m]
  double speed = 0;
  double drive = 0;    // [N m] or [N], from the motor
  double load = 0;     // gravity or spring
  double inertia = 1;  // [kg m^2] or [kg]
};

/// Hidden states of a fault: integrated, and updated once per step.
struct Hidden {
  double first = 0, second = 0, held = 0;
};

/// Bristles of the friction model of Canudas de Wit et al. (1995): natural frequency on the machine's own inertia.
constexpr double stiff_bristles = 300;  // [rad/s]: slip sets in within 1e-4 of the usual motion
constexpr double soft_bristles = 60;    // [rad/s]: a spring can be felt before slip

inline bool is_dry(const Fault& fault) {
  return fault.formula == Formula::dry || fault.formula == Formula::stribeck || fault.formula == Formula::load_dry;
}

/// Dry friction when sliding.
inline double sliding_force(const Fault& fault, const Motion& at) {
  double level = fault.a;
  if (fault.formula == Formula::stribeck) {
    const double ratio = std::abs(at.speed) / fault.c;
    level += fault.b * std::exp(fault.same_formula ? -ratio * ratio : -ratio);
  } else if (fault.formula == Formula::load_dry) {
    level = fault.a * std::abs(fault.c == 0 ? at.drive : at.load);
  }
  return std::max(level, 1e-9);
}

inline double bristle_stiffness(const Fault& fault, const Motion& at) {
  const bool soft = !fault.same_formula && fault.formula == Formula::dry;
  const double frequency = soft ? soft_bristles : stiff_bristles;
  return at.inertia * frequency * frequency;
}

inline double dry_force(const Fault& fault, const Motion& at, double deflection) {
  const double stiffness = bristle_stiffness(fault, at);
  const double damping = std::sqrt(stiffness * at.inertia);
  const double limit = sliding_force(fault, at);
  const double deflection_rate = at.speed - stiffness * std::abs(at.speed) / limit * deflection;
  const double force = stiffness * deflection + damping * deflection_rate;
  return -std::clamp(force, -2 * limit, 2 * limit);
}

/// Bristles after a step at constant speed, exact.
inline double next_deflection(const Fault& fault, const Motion& at, double deflection, double step) {
  const double stiffness = bristle_stiffness(fault, at);
  const double limit = sliding_force(fault, at);
  const double rate = stiffness * std::abs(at.speed) / limit;
  if (rate * step < 1e-6) return deflection + at.speed * step;
  const double steady = std::copysign(limit / stiffness, at.speed);
  return steady + (deflection - steady) * std::exp(-rate * step);
}

inline double play(double position, double held, double half_width) {
  return std::clamp(held, position - half_width, position + half_width);
}

inline double triangle_wave(double phase) { return 2 / std::numbers::pi * std::asin(std::sin(phase)); }

/// Force of a fault on the machine; rates of its hidden states.
inline double fault_force(const Fault& fault, const Motion& at, const Hidden& hidden, Hidden& rates) {
  const double q = at.position, v = at.speed;
  const double circle = 2 * std::numbers::pi;
  switch (fault.formula) {
    case Formula::viscous:
      return -fault.a * v;
    case Formula::dry:
    case Formula::stribeck:
    case Formula::load_dry:
      return dry_force(fault, at, hidden.held);
    case Formula::dry_tanh:
      return -fault.a * std::tanh(v / fault.b);
    case Formula::drag:
      return fault.same_formula ? -fault.a * v * std::abs(v) : -fault.a * std::copysign(std::pow(std::abs(v), 1.8), v);
    case Formula::constant:
      return fault.a;
    case Formula::cubic:
      return fault.same_formula ? -fault.a * q * q * q
                                : -fault.a * 6 * fault.b * fault.b * (fault.b * std::sinh(q / fault.b) - q);
    case Formula::hysteresis:
      rates.first = v - std::abs(v) * hidden.first / fault.b;
      return -fault.a * hidden.first / fault.b;
    case Formula::hysteresis_square: {
      const double z = hidden.first / fault.b;
      rates.first = v - 0.6 * std::abs(v) * std::abs(z) * z - 0.4 * v * z * z;
      return -fault.a * z;
    }
    case Formula::elasticity: {  // a second inertia on a spring: its position and speed relative to the start
      const double inertia = fault.a * at.inertia;
      const double frequency = circle * fault.b;
      const double spring =
          inertia * (frequency * frequency * (hidden.first - q) + 2 * fault.c * frequency * (hidden.second - v));
      rates.first = hidden.second;
      rates.second = -spring / inertia;
      return spring;
    }
    case Formula::cogging:
      return fault.a * std::sin(circle * q / fault.b + fault.c);
    case Formula::cogging_triangle:
      return fault.a * triangle_wave(circle * q / fault.b + fault.c);
    case Formula::gravity_offset:
      return fault.a * std::cos(q);
    case Formula::stop_spring: {
      const double depth = fault.b > 0 ? std::max(q - fault.a, 0.0) : std::min(q - fault.a, 0.0);
      const double frequency = circle * 25;
      if (depth == 0) return 0;
      return -at.inertia * (frequency * frequency * depth + frequency * v);
    }
    case Formula::detent: {
      const double x = (q - fault.b) / fault.c;
      return -fault.a * x * std::exp(0.5 - 0.5 * x * x);
    }
    case Formula::sticky_patch: {
      const double x = (q - fault.b) / fault.c;
      return -fault.a * v / (1 + x * x * x * x);
    }
    case Formula::warm_spring:
      rates.first = std::abs(v) / fault.b - hidden.first / fault.c;
      return -fault.a * at.load * hidden.first;
    case Formula::gusts:
      return fault.a * std::sin(circle * at.time / fault.b + fault.c);
    case Formula::weak_zone: {
      const double x = (q - fault.b) / fault.c;
      return -fault.a * at.drive * std::exp(-0.5 * x * x);
    }
    default:
      return 0;
  }
}

}  // namespace plants
