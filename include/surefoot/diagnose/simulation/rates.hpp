// Rates of the states of a simulator and of the hidden states of the effects attached to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/diagnose/simulation/generalized_forces.hpp"

namespace surefoot::diagnosis {

/// What a dry friction does during a step.
enum class Mode : std::int8_t { back = -1, stuck = 0, forth = 1 };

/// The states as they would be without inputs, at the same positions and speeds.
template <Simulator S>
typename S::State undriven_states(const AugmentedSimulator<S>& m, const typename S::State& x) {
  auto undriven = copied(x);
  for (Eigen::Index i = 0; i < undriven.size(); ++i) {
    if (m.structure.actuator[static_cast<std::size_t>(i)]) undriven[i] = 0;
  }
  return undriven;
}

/// The rates as they would be without inputs.
template <Simulator S>
typename S::State undriven_rates(const AugmentedSimulator<S>& m, const typename S::State& x,
                                 const typename S::Input& u) {
  auto undriven = copied(u);
  if (!m.driven_signals) undriven.setZero();
  const auto no_drive = [&m](int i, double value) {
    return m.structure.driven_signal[static_cast<std::size_t>(i)] ? 0.0 : value;
  };
  return evaluate(m.simulator, undriven_states(m, x), undriven, m.p, no_drive);
}

/// That of one state alone.
template <Simulator S>
double undriven_rate(const AugmentedSimulator<S>& m, const EffectSlot& slot, const typename S::State& x,
                     const typename S::Input& u) {
  auto undriven = copied(u);
  if (!m.driven_signals) undriven.setZero();
  if constexpr (requires { m.simulator.rate_without(m.structure.driven_signal, slot.at, x, undriven); }) {
    return m.simulator.rate_without(m.structure.driven_signal, slot.at, undriven_states(m, x), undriven);
  } else {
    return undriven_rates(m, x, u)[slot.at];
  }
}

/// The force on a state of which the rates are f, beyond what it would be without inputs.
template <Simulator S>
double driven_force(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, const EffectSlot& slot,
                    const typename S::State& x, const typename S::State& f, const typename S::Input& u) {
  if (number_of_pushed(m.structure, slot.at) < 0) {
    return response.effort[slot.at] * (f[slot.at] - undriven_rate(m, slot, x, u));
  }
  auto driven = undriven_rates(m, x, u);
  for (Eigen::Index i = 0; i < driven.size(); ++i) driven[i] = f[i] - driven[i];
  return force_on(m, response, slot.at, driven);
}

/// The force on a state that remains without inputs.
template <Simulator S>
double undriven_force(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, const EffectSlot& slot,
                      const typename S::State& x, const typename S::Input& u) {
  if (number_of_pushed(m.structure, slot.at) < 0) return response.effort[slot.at] * undriven_rate(m, slot, x, u);
  return force_on(m, response, slot.at, undriven_rates(m, x, u));
}

/// By how much the force on a state falls as the state grows, by a difference over a tenth of its size.
template <Simulator S>
double damping_of(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, const EffectSlot& slot,
                  const typename S::State& x, const typename S::State& f, const typename S::Input& u) {
  const double by = 0.1 * slot.size;
  if (!(by > 0)) return 0;
  auto faster = copied(x);
  faster[slot.at] += by;
  const bool as_it_is = m.slots.taps.empty() && m.slots.seen.empty();  // then it has been evaluated already
  auto change = as_it_is ? copied(f) : evaluate(m.simulator, x, u, m.p, NoTap{});
  const auto fast = evaluate(m.simulator, faster, u, m.p, NoTap{});
  for (Eigen::Index i = 0; i < change.size(); ++i) change[i] -= fast[i];
  return force_on(m, response, slot.at, change) / by;
}

/// Fills in what an effect asks for of the parts of the force on a state; f are the rates there.
template <Simulator S>
void split_force(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, EffectContext& now,
                 const EffectSlot& slot, const typename S::State& x, const typename S::State& f,
                 const typename S::Input& u) {
  const Effect& effect = *slot.effect;
  if (effect.needs_drive) now.drive = driven_force(m, response, slot, x, f, u);
  if (effect.needs_damping) now.damping = damping_of(m, response, slot, x, f, u);
  if (!effect.needs_load) return;
  auto rest = copied(x);
  rest[slot.at] = 0;
  now.load = undriven_force(m, response, slot, rest, u);
}

/// Level of a dry friction.
template <Simulator S>
double level(const AugmentedSimulator<S>& m, const EffectSlot& slot, const typename S::State& x,
             const typename S::State& f, const ForceResponse<S>& response, const typename S::Input& u, double t,
             double h) {
  EffectContext now = context_at_state(m, slot, x, f, response.effort, t, h);
  split_force(m, response, now, slot, x, f, u);
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

/// Velocities that stick, each once.
inline std::vector<int> stuck_velocities(const std::vector<EffectSlot>& dry, const std::vector<Mode>& modes) {
  std::vector<int> stuck;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (modes[i] != Mode::stuck) continue;
    if (std::find(stuck.begin(), stuck.end(), dry[i].at) == stuck.end()) stuck.push_back(dry[i].at);
  }
  return stuck;
}

/// The force that holds a velocity, one of those that stick; `free` are the rates if nothing held them.
template <Simulator S>
double holding_force(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, const std::vector<Mode>& modes,
                     int at, const typename S::State& free) {
  if constexpr (has_response<S>) {
    if (number_of_pushed(m.structure, at) >= 0) {
      std::vector<int> stuck;
      for (const int other : stuck_velocities(m.slots.dry, modes)) {
        if (number_of_pushed(m.structure, other) >= 0) stuck.push_back(other);
      }
      const Eigen::VectorXd forces = forces_for(m, response, stuck, free);
      for (std::size_t k = 0; k < stuck.size(); ++k) {
        if (stuck[k] == at) return forces[static_cast<Eigen::Index>(k)];
      }
    }
  }
  return response.effort[at] * free[at];
}

/// Adds the creep of what sticks to the rates of positions. `rate` is as if nothing stuck, `model` that of the
/// simulator alone.
template <Simulator S>
void creep(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, const typename S::State& x,
           const typename S::State& model, const typename S::Input& u, double t, double h,
           const std::vector<Mode>& modes, typename S::State& rate) {
  constexpr double most = 0.999;  // of its level, short of where the speed would be infinite
  const auto& dry = m.slots.dry;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const EffectSlot& slot = dry[i];
    if (modes[i] != Mode::stuck || !slot.effect->creep || slot.position < 0) continue;
    double limit = 0;  // of all dry friction there
    for (const EffectSlot& other : dry) limit += other.at == slot.at ? level(m, other, x, model, response, u, t, h) : 0;
    if (!(limit > 0)) continue;
    const double share = holding_force(m, response, modes, slot.at, rate) / limit;
    add_at(rate, slot.position, slot.effect->creep(std::clamp(share, -most, most), slot.p));
  }
}

/// Adds dry friction in a given mode of each to the rates; `model` are those of the simulator alone.
template <Simulator S>
void rub(AugmentedSimulator<S>& m, const ForceResponse<S>& response, const typename S::State& x,
         const typename S::State& model, const typename S::Input& u, double t, double h, const std::vector<Mode>& modes,
         typename S::State& rate) {
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const EffectSlot& slot = m.slots.dry[i];
    if (modes[i] == Mode::stuck) continue;
    push(m, response, slot.at, -static_cast<double>(modes[i]) * level(m, slot, x, model, response, u, t, h), rate);
  }
  creep(m, response, x, model, u, t, h, modes, rate);
  if constexpr (has_response<S>) {
    const std::vector<int> stuck = stuck_velocities(m.slots.dry, modes);
    if (!m.structure.pushed.empty() && !stuck.empty()) return hold(m, response, stuck, rate);
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (modes[i] == Mode::stuck) rate[m.slots.dry[i].at] = 0;
  }
}

/// Rates at a point for a given mode of each dry friction; without modes, as if there were none. Those of hidden states
/// are put into dz where they have any.
template <Simulator S>
typename S::State rates(AugmentedSimulator<S>& m, const typename S::State& x, const Hidden& z, typename S::Input u,
                        Hidden& dz, double t, double h, const std::vector<Mode>& modes) {
  for (const EffectSlot& slot : m.slots.commands) u[slot.at] = through(m, slot, u[slot.at], z, dz, t, h);
  const auto model = equations(m, seen_states(m, x, z, t, h), u, z, dz, t, h);
  auto rate = copied(model);
  if (m.slots.forces.empty() && modes.empty()) return rate;
  const ForceResponse<S> response = force_response(m, x, u);
  for (const EffectSlot& slot : m.slots.forces) {
    EffectContext now = context_at_state(m, slot, x, model, response.effort, t, h);
    split_force(m, response, now, slot, x, model, u);
    if (slot.effect->hidden_rate) slot.effect->hidden_rate(now, slot.p, slot.hidden(z), slot.hidden(dz));
    if (slot.effect->position_rate && slot.position >= 0) {
      add_at(rate, slot.position, slot.effect->position_rate(now, slot.p, slot.hidden(z)));
    }
    if (slot.effect->force) {
      const double force = slot.effect->force(now, slot.p, slot.hidden(z));
      if (slot.effect->place == Place::velocity) {
        push(m, response, slot.at, force, rate);
      } else {
        add_at(rate, slot.at, force);
      }
    }
  }
  rub(m, response, x, model, u, t, h, modes, rate);
  return rate;
}

}  // namespace surefoot::diagnosis
