// Rates of the states of a simulator and of the hidden states of the effects attached to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "surefoot/diagnose/simulation/augmented_simulator.hpp"

namespace surefoot::diagnosis {

/// What a dry friction does during a step.
enum class Mode : std::int8_t { back = -1, stuck = 0, forth = 1 };

/// The rate of a state as it would be without inputs.
template <Simulator S>
double undriven_rate(const AugmentedSimulator<S>& m, const EffectSlot& slot, const typename S::State& x,
                     const typename S::Input& u) {
  auto undriven = copied(u);
  if (!m.driven_signals) undriven.setZero();
  if constexpr (requires { m.simulator.rate_without(m.structure.driven_signal, slot.at, x, undriven); }) {
    return m.simulator.rate_without(m.structure.driven_signal, slot.at, x, undriven);
  } else {
    const auto no_drive = [&m](int i, double value) {
      return m.structure.driven_signal[static_cast<std::size_t>(i)] ? 0.0 : value;
    };
    return evaluate(m.simulator, x, undriven, m.p, no_drive)[slot.at];
  }
}

/// By how much the force on a state falls as the state grows, by a difference over a tenth of its size.
template <Simulator S>
double damping_of(const AugmentedSimulator<S>& m, const EffectContext& now, const EffectSlot& slot,
                  const typename S::State& x, const typename S::Input& u) {
  const double by = 0.1 * slot.size;
  if (!(by > 0)) return 0;
  auto faster = copied(x);
  faster[slot.at] += by;
  const bool as_it_is = m.slots.taps.empty() && m.slots.seen.empty();  // then it has been evaluated already
  const double slow = as_it_is ? now.rate : evaluate(m.simulator, x, u, m.p, NoTap{})[slot.at];
  return now.effort * (slow - evaluate(m.simulator, faster, u, m.p, NoTap{})[slot.at]) / by;
}

/// Fills in what an effect asks for of the parts of the force on a state.
template <Simulator S>
void split_force(const AugmentedSimulator<S>& m, EffectContext& now, const EffectSlot& slot, const typename S::State& x,
                 const typename S::Input& u) {
  const Effect& effect = *slot.effect;
  if (!effect.needs_drive && !effect.needs_damping) return;
  if (effect.needs_drive) now.drive = now.effort * (now.rate - undriven_rate(m, slot, x, u));
  if (effect.needs_damping) now.damping = damping_of(m, now, slot, x, u);
  auto rest = copied(x);
  rest[slot.at] = 0;
  now.load = now.effort * undriven_rate(m, slot, rest, u);
}

/// Level of a dry friction.
template <Simulator S>
double level(const AugmentedSimulator<S>& m, const EffectSlot& slot, const typename S::State& x,
             const typename S::State& f, const typename S::State& e, const typename S::Input& u, double t, double h) {
  EffectContext now = context_at_state(m, slot, x, f, e, t, h);
  split_force(m, now, slot, x, u);
  return std::max(0.0, slot.effect->dry(now, slot.p));
}

/// The states that the equations see, with effects on positions.
template <Simulator S>
inline typename S::State seen_states(const AugmentedSimulator<S>& m, const typename S::State& x, const Hidden& z,
                                     double t, double h) {
  auto seen = copied(x);
  for (const EffectSlot& slot : m.slots.seen) {
    if (slot.position < 0) continue;
    EffectContext now = context(m, x[slot.at], t, h);
    now.position = x[slot.position];
    seen[slot.position] = slot.effect->seen_position(now, slot.p, slot.hidden(z));
  }
  return seen;
}

/// Rates at a point for a given mode of each dry friction; without modes, as if there were none. Those of hidden states
/// are put into dz where they have any.
template <Simulator S>
typename S::State rates(AugmentedSimulator<S>& m, const typename S::State& x, const Hidden& z, typename S::Input u,
                        Hidden& dz, double t, double h, std::span<const Mode> modes) {
  for (const EffectSlot& slot : m.slots.commands) u[slot.at] = through(m, slot, u[slot.at], z, dz, t, h);
  const auto model = equations(m, seen_states(m, x, z, t, h), u, z, dz, t, h);
  auto rate = copied(model);
  if (m.slots.forces.empty() && modes.empty()) return rate;
  const auto e = effort(m, x, u);
  for (const EffectSlot& slot : m.slots.forces) {
    EffectContext now = context_at_state(m, slot, x, model, e, t, h);
    split_force(m, now, slot, x, u);
    if (slot.effect->hidden_rate) slot.effect->hidden_rate(now, slot.p, slot.hidden(z), slot.hidden(dz));
    if (slot.effect->position_rate && slot.position >= 0) {
      add_at(rate, slot.position, slot.effect->position_rate(now, slot.p, slot.hidden(z)));
    }
    if (slot.effect->force) {
      const double force = slot.effect->force(now, slot.p, slot.hidden(z));
      add_at(rate, slot.at, slot.effect->place == Place::velocity ? force * (1 / e[slot.at]) : force);
    }
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const EffectSlot& slot = m.slots.dry[i];
    if (modes[i] == Mode::stuck) continue;
    add_at(rate, slot.at, -static_cast<double>(modes[i]) / e[slot.at] * level(m, slot, x, model, e, u, t, h));
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (modes[i] == Mode::stuck) rate[m.slots.dry[i].at] = 0;
  }
  return rate;
}

}  // namespace surefoot::diagnosis
