// A simulator with effects attached to it, ready to run, and what those effects see and do inside its equations.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulation/effect_slots.hpp"
#include "surefoot/diagnose/simulation/signal_history.hpp"
#include "surefoot/diagnose/simulation/small_vectors.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"

namespace surefoot::diagnosis {

/// States and hidden states, or their rates.
template <Simulator S>
struct Point {
  typename S::State x;
  Hidden z;
};

/// A simulator with effects; `simulator` must be prepared for the recording and for p.
template <Simulator S>
struct AugmentedSimulator {
  S& simulator;
  const SimulatorStructure& structure;
  Eigen::VectorXd p;
  EffectSlots slots;
  double start = 0;             // time of the first row
  std::vector<double> raw;      // by effect: the input or signal that it last saw
  std::vector<SignalHistory> past = {};  // by effect: of the signal that it makes come late
  bool driven_signals = false;  // some signal inside the equations depends on the inputs
};

template <Simulator S>
typename S::State effort(const AugmentedSimulator<S>& m, const typename S::State& x, const typename S::Input& u) {
  if constexpr (requires { m.simulator.effort(x, u, m.p); }) {
    return m.simulator.effort(x, u, m.p);
  } else {
    auto one = unset<typename S::State>(x.size());
    one.setOnes();
    return one;
  }
}

template <Simulator S>
EffectContext context(const AugmentedSimulator<S>& m, double value, double t, double h) {
  return {.time = t - m.start, .step = h, .value = value};
}

/// Of an effect on a state, whose rates and efforts are f and e.
template <Simulator S>
EffectContext context_at_state(const AugmentedSimulator<S>& m, const EffectSlot& slot, const typename S::State& x,
                               const typename S::State& f, const typename S::State& e, double t, double h) {
  EffectContext result = context(m, x[slot.at], t, h);
  if (slot.position >= 0) result.position = x[slot.position];
  result.rate = f[slot.at];
  result.effort = e[slot.at];
  return result;
}

/// An input or signal on its way through an effect.
template <Simulator S>
double through(AugmentedSimulator<S>& m, const EffectSlot& slot, double value, const Hidden& z, Hidden& dz, double t,
               double h) {
  EffectContext now = context(m, value, t, h);
  now.drive = value;
  m.raw[slot.number] = value;
  if (slot.effect->delay)
    return m.past[slot.number].delayed(t, value, slot.effect->delay(slot.p), slot.effect->from_rest);
  if (slot.effect->hidden_rate) slot.effect->hidden_rate(now, slot.p, slot.hidden(z), slot.hidden(dz));
  return slot.effect->signal(now, slot.p, slot.hidden(z));
}

/// Signals inside the equations on their way through effects, as a tap.
template <Simulator S>
auto tap_of(AugmentedSimulator<S>& m, const Hidden& z, Hidden& dz, double t, double h) {
  return [&m, &z, &dz, t, h](int signal, double value) {
    for (const EffectSlot& slot : m.slots.taps) {
      if (slot.at == signal) value = through(m, slot, value, z, dz, t, h);
    }
    return value;
  };
}

/// The simulator's own rates, or next values, at x with effects on signals.
template <Simulator S>
inline typename S::State equations(AugmentedSimulator<S>& m, const typename S::State& x, const typename S::Input& u,
                                   const Hidden& z, Hidden& dz, double t, double h) {
  if (m.slots.taps.empty()) return evaluate(m.simulator, x, u, m.p, NoTap{});
  return evaluate(m.simulator, x, u, m.p, tap_of(m, z, dz, t, h));
}

}  // namespace surefoot::diagnosis
