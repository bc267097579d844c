// Rates of the states of a simulator and of the hidden states of the effects attached to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "surefoot/diagnose/augmented_simulator.hpp"

namespace surefoot::detail {

/// What a dry friction does during a step.
enum class Mode : std::int8_t { back = -1, stuck = 0, forth = 1 };

/// Splits the force on a state into what inputs cause and what remains at rest.
template <Simulator S>
void split_drive(const AugmentedSimulator<S>& m, Moment& now, const Slot& slot, const typename S::State& x,
                 const typename S::Input& u) {
  auto undriven = copied(u);
  if (!m.driven_signals) undriven.setZero();
  const auto no_drive = [&m](int i, double value) {
    return m.facts.driven_signal[static_cast<std::size_t>(i)] ? 0.0 : value;
  };
  now.drive = now.effort * (now.rate - evaluate(m.simulator, x, undriven, m.p, no_drive)[slot.at]);
  auto rest = copied(x);
  rest[slot.at] = 0;
  now.load = now.effort * evaluate(m.simulator, rest, undriven, m.p, no_drive)[slot.at];
}

/// Level of a dry friction.
template <Simulator S>
double level(const AugmentedSimulator<S>& m, const Slot& slot, const Point<S>& at, const typename S::State& f,
             const typename S::State& e, const typename S::Input& u, double t, double h) {
  Moment now = moment_at_state(m, slot, at, f, e, t, h);
  if (slot.effect->needs_drive) split_drive(m, now, slot, at.x, u);
  return std::max(0.0, slot.effect->dry(now, slot.p));
}

/// The equations, with effects on the positions that they see.
template <Simulator S>
inline typename S::State seen_equations(AugmentedSimulator<S>& m, const Point<S>& at, const typename S::Input& u,
                                        Hidden& dz, double t, double h) {
  if (m.slots.seen.empty()) return equations(m, at.x, u, at, dz, t, h);
  auto seen = copied(at.x);
  for (const Slot& slot : m.slots.seen) {
    if (slot.position < 0) continue;
    Moment now = moment(m, at.x[slot.at], t, h);
    now.position = at.x[slot.position];
    seen[slot.position] = slot.effect->seen_position(now, slot.p, slot.hidden(at.z));
  }
  return equations(m, seen, u, at, dz, t, h);
}

/// Rates at a point for a given mode of each dry friction; without modes, as if there were none.
template <Simulator S>
Point<S> rates(AugmentedSimulator<S>& m, const Point<S>& at, typename S::Input u, double t, double h,
               std::span<const Mode> modes) {
  Point<S> rate{unset<typename S::State>(at.x.size()), Hidden::Zero(m.slots.hidden)};
  for (const Slot& slot : m.slots.orders) u[slot.at] = through(m, slot, u[slot.at], at, rate.z, t, h);
  const auto model = seen_equations(m, at, u, rate.z, t, h);
  assign(rate.x, model);
  if (m.slots.forces.empty() && modes.empty()) return rate;
  const auto e = effort(m, at.x, u);
  for (const Slot& slot : m.slots.forces) {
    Moment now = moment_at_state(m, slot, at, model, e, t, h);
    if (slot.effect->needs_drive) split_drive(m, now, slot, at.x, u);
    if (slot.effect->memory_rate) slot.effect->memory_rate(now, slot.p, slot.hidden(at.z), slot.hidden(rate.z));
    if (slot.effect->force) {
      const double force = slot.effect->force(now, slot.p, slot.hidden(at.z));
      add_at(rate.x, slot.at, slot.effect->place == Place::velocity ? force * (1 / e[slot.at]) : force);
    }
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const Slot& slot = m.slots.dry[i];
    if (modes[i] == Mode::stuck) continue;
    add_at(rate.x, slot.at, -static_cast<double>(modes[i]) / e[slot.at] * level(m, slot, at, model, e, u, t, h));
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (modes[i] == Mode::stuck) rate.x[m.slots.dry[i].at] = 0;
  }
  return rate;
}

}  // namespace surefoot::detail
