// Actions of effects once in each step: hidden states that jump, limits, displacements in the plane; and the step of a
// map, which is nothing else.
#pragma once

#include <cmath>
#include <optional>

#include "surefoot/diagnose/simulation/generalized_forces.hpp"

namespace surefoot::diagnosis {

/// What an effect with hidden states sees between steps.
template <Simulator S>
EffectContext update_context(const AugmentedSimulator<S>& m, const EffectSlot& slot, const Point<S>& now, double t,
                             double h) {
  if (slot.effect->place == Place::input) return context(m, m.raw[slot.number], t, h);
  EffectContext result = context(m, now.x[slot.at], t, h);
  if (slot.position >= 0) result.position = now.x[slot.position];
  return result;
}

/// After a jump of a velocity by a limit: the impulse behind it moves all velocities that the mass matrix couples to
/// it.
template <Simulator S>
void share_impulse(const AugmentedSimulator<S>& m, Point<S>& now, const typename S::Input& u, int at, double jump) {
  const int number = number_of_pushed(m.structure, at);
  if (number < 0 || jump == 0) return;
  const auto response = force_response(m, now.x, u);
  const double own = now.x[at];
  push(m, response, at, jump * response.effort[at], now.x);
  now.x[at] = own;
}

template <Simulator S>
void apply_step_updates(const AugmentedSimulator<S>& m, Point<S>& now, const typename S::Input& u, double t, double h) {
  for (const EffectSlot& slot : m.slots.updates) {
    if (!slot.effect->advance) continue;
    slot.effect->advance(update_context(m, slot, now, t, h), slot.p, slot.hidden(now.z));
  }
  for (const EffectSlot& slot : m.slots.limits) {
    double no_position = 0, no_other = 0;
    const double before = now.x[slot.at];
    slot.effect->limit(slot.p, now.x[slot.at], slot.position >= 0 ? now.x[slot.position] : no_position,
                       slot.other >= 0 ? now.x[slot.other] : no_other);
    if constexpr (has_response<S>) share_impulse(m, now, u, slot.at, now.x[slot.at] - before);
  }
}

/// An end stop that a step went beyond.
struct StopHit {
  int velocity = -1, position = -1;  // states; none
  double level = 0;                  // of the position
  double beyond = 0;                 // for how long the step went on, as far as its last speed tells

  /// How much later the state is at the stop.
  template <class State>
  double until(const State& x) const {
    return (level - x[position]) / x[velocity];
  }
};

/// The stop that was hit first in a step; none for those that were rested on from its beginning.
template <Simulator S>
StopHit first_hit(const EffectSlots& slots, const Point<S>& before, const Point<S>& after) {
  StopHit first;
  for (const EffectSlot& slot : slots.limits) {
    if (slot.position < 0) continue;
    double value = after.x[slot.at], position = after.x[slot.position], no_other = 0;
    slot.effect->limit(slot.p, value, position, no_other);
    if (position == after.x[slot.position] || position == before.x[slot.position]) continue;
    StopHit hit{slot.at, slot.position, position};
    hit.beyond = -hit.until(after.x);
    if (hit.beyond > first.beyond) first = hit;
  }
  return first;
}

/// Effects on the displacement from one pose to the next.
template <class State>
void move_in_plane(const EffectSlots& slots, const PlanarInfo& at, const State& before, State& after) {
  const double heading = before[at.heading], c = std::cos(heading), s = std::sin(heading);
  const double x = after[at.x] - before[at.x], y = after[at.y] - before[at.y];
  Pose2 moved{c * x + s * y, -s * x + c * y, after[at.heading] - heading};
  for (const EffectSlot& slot : slots.planar) moved = slot.effect->planar(moved, heading, slot.p);
  after[at.x] = before[at.x] + c * moved.x - s * moved.y;
  after[at.y] = before[at.y] + s * moved.x + c * moved.y;
  after[at.heading] = heading + moved.angle;
}

/// A step of a map, up to what is done after it.
template <Simulator S>
void next_values(AugmentedSimulator<S>& m, typename S::Input u, Point<S>& now, double t,
                 const std::optional<PlanarInfo>& planar) {
  const auto before = now.x;
  Hidden dz = Hidden::Zero(m.slots.hidden);
  for (const EffectSlot& slot : m.slots.commands) u[slot.at] = through(m, slot, u[slot.at], now.z, dz, t, 1);
  now.x = equations(m, before, u, now.z, dz, t, 1);
  for (const EffectSlot& slot : m.slots.forces) {
    EffectContext change = context(m, before[slot.at], t, 1);
    change.rate = now.x[slot.at] - before[slot.at];
    if (slot.effect->force) now.x[slot.at] += slot.effect->force(change, slot.p, slot.hidden(now.z));
  }
  if (!m.slots.planar.empty()) move_in_plane(m.slots, *planar, before, now.x);
  now.z += dz;
}

}  // namespace surefoot::diagnosis
