// Forces on speeds.
#include <cmath>
#include <numbers>

#include "circle.hpp"
#include "laws.hpp"

namespace machines {
namespace {

// Natural frequencies on the machine's own inertia, in radians per row: stiff enough to be hidden between two rows, or
// soft enough to be seen.
constexpr double stiff_bristles = 1.5, soft_bristles = 0.5, stiff_contact = 0.9;

double sliding_level(const Hidden& one, const Motion& motion) {
  const double ratio = std::abs(motion.speed) / (one.c > 0 ? one.c : 1);
  double level = one.a;
  if (one.law == Law::stribeck_gauss) level += one.a * one.b * std::exp(-ratio * ratio);
  if (one.law == Law::stribeck_exponential) level += one.a * one.b * std::exp(-ratio);
  if (one.law == Law::stribeck_lorentz) level += one.a * one.b / (1 + ratio * ratio);
  if (one.law == Law::load_bristles) level = one.a * std::abs(one.b == 0 ? motion.drive : motion.load);
  return std::max(level, 1e-12 * motion.inertia);
}

double bristle_stiffness(const Hidden& one, const Motion& motion) {
  // Bristles pressed harder are stiffer: they slip after the same way under any load. With a constant stiffness they
  // would let go each time that the load passes zero, in no time at all, which no integration follows.
  if (one.law == Law::load_bristles) return sliding_level(one, motion) / one.c;
  const double frequency = (one.law == Law::soft_bristles ? soft_bristles : stiff_bristles) / motion.period;
  return motion.inertia * frequency * frequency;
}

double bristle_force(const Hidden& one, const Motion& motion, double deflection) {
  const double stiffness = bristle_stiffness(one, motion), limit = sliding_level(one, motion);
  const double damping = std::sqrt(stiffness * motion.inertia);
  const double rate = motion.speed - stiffness * std::abs(motion.speed) / limit * deflection;
  return -std::clamp(stiffness * deflection + damping * rate, -2 * limit, 2 * limit);
}

double triangle_wave(double phase) { return 2 / std::numbers::pi * std::asin(std::sin(phase)); }

double spring_of_contact(const Motion& motion) {
  const double frequency = stiff_contact / motion.period;
  return motion.inertia * frequency * frequency;
}

// A second inertia, `ratio` times the first: its position and speed in memory[0] and memory[1].
double second_mass(const Hidden& one, const Motion& motion, std::span<const double> memory, std::span<double> change,
                   double ratio, double frequency) {
  const double inertia = ratio * motion.inertia;
  const double twist = memory[0] - motion.position, speed = memory[1] - motion.speed;
  const double force = inertia * (frequency * frequency * twist + 2 * one.c * frequency * speed);
  change[0] = memory[1];
  change[1] = -force / inertia;
  return force;
}

double load_behind_gap(const Hidden& one, const Motion& motion, std::span<const double> memory,
                       std::span<double> change) {
  const double inertia = one.b * motion.inertia;
  const double twist = memory[0] - motion.position, depth = twist - std::clamp(twist, -one.a, one.a);
  const double frequency = stiff_contact / motion.period * std::sqrt(1 / (1 + 1 / one.b));
  const double damping = depth == 0 ? 0 : 0.8 * frequency * (memory[1] - motion.speed);
  const double force = inertia * (frequency * frequency * depth + damping);
  change[0] = memory[1];
  change[1] = -force / inertia;
  return force;
}

double friction(const Hidden& one, const Motion& motion, double held) {
  const double v = motion.speed;
  switch (one.law) {
    case Law::viscous:
      return -one.a * v;
    case Law::smooth_dry:
      return -one.a * std::tanh(v / one.b);
    case Law::arctan_dry:
      return -one.a * 2 / std::numbers::pi * std::atan(2 * v / one.b);
    case Law::rational_dry:
      return -one.a * v / (std::abs(v) + 0.5 * one.b);
    case Law::square_drag:
      return -one.a * v * std::abs(v);
    case Law::power_drag:
      return -one.a * std::copysign(std::pow(std::abs(v), one.b), v);
    case Law::asymmetric_damping:
      return -one.a * v * (v > 0 ? 1 : one.b);
    default:
      return bristle_force(one, motion, held);
  }
}

double hysteresis(const Hidden& one, const Motion& motion, std::span<const double> memory, std::span<double> change) {
  const double z = memory[0] / one.b, v = motion.speed;
  if (one.law == Law::dahl) {
    change[0] = v - std::abs(v) * z;
  } else {
    change[0] = v - 0.6 * std::abs(v) * std::abs(z) * z - 0.4 * v * z * z;
  }
  return -one.a * z;
}

double force_at_position(const Hidden& one, const Motion& motion) {
  const double q = motion.position, x = one.c != 0 ? (q - one.b) / one.c : 0;
  switch (one.law) {
    case Law::constant:
      return one.a;
    case Law::cubic:
      return -one.a * q * q * q;
    case Law::sinh_spring:
      return -one.a * 6 * one.b * one.b * (one.b * std::sinh(q / one.b) - q);
    case Law::tangent_spring: {
      const double ratio = std::clamp(q / (2 * one.b), -1.45, 1.45);
      return -one.a * 24 * one.b * one.b * one.b * (std::tan(ratio) - ratio);
    }
    case Law::weight_offset:
      return one.a * std::cos(q);
    case Law::sine_cogging:
      return one.a * std::sin(circle * q / one.b + one.c);
    case Law::triangle_cogging:
      return one.a * triangle_wave(circle * q / one.b + one.c);
    case Law::two_wave_cogging:
      return one.a * (std::sin(circle * q / one.b + one.c) + 0.5 * std::sin(2 * circle * q / one.b - one.c));
    case Law::elastic_stop: {
      const double depth = one.b > 0 ? std::max(q - one.a, 0.0) : std::min(q - one.a, 0.0);
      if (depth == 0) return 0;
      return -spring_of_contact(motion) * depth - std::sqrt(spring_of_contact(motion) * motion.inertia) * motion.speed;
    }
    case Law::detent:
      return -one.a * x * std::exp(0.5 - 0.5 * x * x);
    case Law::sticky_patch:
      return -one.a * motion.speed / (1 + x * x * x * x);
    case Law::weak_zone:
      return -one.a * motion.drive * std::exp(-0.5 * x * x);
    default:
      return 0;
  }
}

}  // namespace

bool has_bristles(Law law) {
  return law == Law::bristles || law == Law::soft_bristles || law == Law::stribeck_gauss ||
         law == Law::stribeck_exponential || law == Law::stribeck_lorentz || law == Law::load_bristles;
}

bool has_second_mass(Law law) {
  return law == Law::resonator || law == Law::load_behind_gap || law == Law::two_resonators;
}

double next_deflection(const Hidden& one, const Motion& motion, double deflection, double step) {
  const double stiffness = bristle_stiffness(one, motion), limit = sliding_level(one, motion);
  const double rate = stiffness * std::abs(motion.speed) / limit;
  if (rate * step < 1e-6) return deflection + motion.speed * step;
  const double steady = std::copysign(limit / stiffness, motion.speed);
  return steady + (deflection - steady) * std::exp(-rate * step);
}

double force_of(const Hidden& one, const Motion& motion, std::span<const double> memory, double held,
                std::span<double> change) {
  switch (one.law) {
    case Law::dahl:
    case Law::square_hysteresis:
      return hysteresis(one, motion, memory, change);
    case Law::resonator:
      return second_mass(one, motion, memory, change, one.a, one.b);
    case Law::two_resonators:
      return second_mass(one, motion, memory, change, one.a, one.b) +
             second_mass(one, motion, memory.subspan(2), change.subspan(2), one.a, one.b * one.d);
    case Law::load_behind_gap:
      return load_behind_gap(one, motion, memory, change);
    case Law::growing_inertia: {
      const double growth = one.a / (1 + std::exp(-(std::abs(motion.position) - one.b) / one.c));
      return -motion.inertia * motion.rate * growth / (1 + growth);
    }
    case Law::gusts:
      return one.a * std::sin(circle * motion.time / one.b + one.c);
    case Law::heat_fade:
      change[0] = std::abs(motion.drive) / (one.b * one.c) - memory[0] / one.c;
      return -motion.drive * std::min(one.a * memory[0], 0.95);
    case Law::viscous:
    case Law::smooth_dry:
    case Law::arctan_dry:
    case Law::rational_dry:
    case Law::square_drag:
    case Law::power_drag:
    case Law::asymmetric_damping:
      return friction(one, motion, held);
    default:
      return has_bristles(one.law) ? friction(one, motion, held) : force_at_position(one, motion);
  }
}

}  // namespace machines
