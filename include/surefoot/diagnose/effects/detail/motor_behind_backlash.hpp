// Motor behind backlash: it drives a load through a gap; together they are what the equations move, but in two parts.
//
// J is the inertia of both, `share` the motor's; D acts on the motor and L on the load, where both move at the speed v
// of the load. The motor runs ahead by d, w = d', and `damping` is by how much D falls per unit of speed:
//   w' = (D - damping w)/(share J) - L/((1 - share) J)   between the ends of the gap.
// There the parts neither give way nor rebound: w = 0 while w' points outwards. Momentum share J (v + w) of the motor
// and (1 - share) J v of the load add up, hence on the equations of both as one
//   force = -damping w - share J w'                      with the impulse w' of each end that is met,
// which vanishes without a gap. Hidden states: d and w at the beginning of the step, and the same as they go on within
// it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "surefoot/diagnose/effects/detail/two_masses.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// First time at which something at 0 gets to `distance` >= 0 ahead, at speed w and acceleration a; infinite if never.
inline double arrival(double distance, double w, double a) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const double squared = w * w + 2 * a * distance;
  if (squared < 0) return never;
  if (w > 0) return 2 * distance / (w + std::sqrt(squared));
  return a > 0 ? (std::sqrt(squared) - w) / a : never;
}

/// The offset after a time `step` of constant acceleration a, less `drag` w [1/s], within half_width to either side.
inline Offset cross(double half_width, Offset at, double a, double drag, double step) {
  for (int meeting = 0; meeting < 3 && step > 0; ++meeting) {
    if (std::abs(at.d) >= half_width && at.w * at.d >= 0) {
      at = {std::copysign(half_width, at.d), 0};
      if (a * at.d >= 0) return at;
    }
    const double mean = (a - drag * at.w) / (1 + 0.5 * drag * step);
    const double ahead = arrival(half_width - at.d, at.w, mean), behind = arrival(half_width + at.d, -at.w, -mean);
    const double time = std::min(ahead, behind);
    if (time >= step) return {at.d + step * (at.w + 0.5 * step * mean), at.w + step * mean};
    at = {ahead < behind ? half_width : -half_width, 0};
    step -= time;
  }
  return at;
}

struct MotorBehindBacklash {
  double half_width = 0, inertia = 1;

  double share(const EffectContext& m) const { return std::clamp(inertia / m.effort, 0.02, 0.98); }

  /// Mean rates of d and w over the step that begins.
  Offset mean_rates(const EffectContext& m, Values hidden) const {
    if (!(m.step > 0)) return {};
    const double load = m.load / m.effort, s = share(m), drag = std::max(0.0, m.damping / (s * m.effort));
    const Offset before{hidden[0], hidden[1]};
    const Offset after = cross(half_width, before, (m.rate - load) / s - load / (1 - s), drag, m.step);
    return {(after.d - before.d) / m.step, (after.w - before.w) / m.step};
  }
  double force(const EffectContext& m, Values hidden) const {
    const Offset rates = mean_rates(m, hidden);
    return -std::max(0.0, m.damping) * rates.d - share(m) * m.effort * rates.w;
  }
  /// The momentum of both moves their center of mass steadily, whenever within the step the load is hit.
  double position_rate(const EffectContext& m, Values hidden) const {
    const Offset rates = mean_rates(m, hidden);
    return share(m) * (hidden[1] + 0.5 * m.step * rates.w - rates.d);
  }
  void advance(HiddenStates hidden) const {
    hidden[0] = hidden[2] = std::clamp(hidden[2], -half_width, half_width);
    hidden[1] = hidden[3];
  }
};

}  // namespace surefoot::effects
