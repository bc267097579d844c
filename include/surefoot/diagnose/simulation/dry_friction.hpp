// Dry friction in a step: neither smoothed nor stiff. Each velocity slides in one direction or sticks for the whole
// step, which is cut where one of them would reverse.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "surefoot/diagnose/simulation/input_signal.hpp"
#include "surefoot/diagnose/simulation/rates.hpp"

namespace surefoot::diagnosis {

inline bool rests(const EffectSlot& slot, double velocity) { return !(std::abs(velocity) > 1e-12 * slot.size); }

/// Sliding or stuck, by dry friction, from the beginning of a step on. Those of one velocity add up.
template <Simulator S>
void decide_modes(AugmentedSimulator<S>& m, const Point<S>& at, const InputSignal<typename S::Input>& inputs, double t,
                  double h, std::span<Mode> modes) {
  const auto& dry = m.slots.dry;
  bool any_rests = false;
  for (std::size_t i = 0; i < dry.size(); ++i) {
    const double velocity = at.x[dry[i].at];
    modes[i] = rests(dry[i], velocity) ? Mode::stuck : velocity > 0 ? Mode::forth : Mode::back;
    any_rests = any_rests || modes[i] == Mode::stuck;
  }
  if (!any_rests) return;
  const auto u = inputs.between(t, h, 0);
  Hidden dz = Hidden::Zero(m.slots.hidden);
  const auto f = rates(m, at.x, at.z, u, dz, t, h, {});  // without dry friction
  const auto e = effort(m, at.x, u);
  for (std::size_t i = 0; i < dry.size(); ++i) {
    if (!rests(dry[i], at.x[dry[i].at])) continue;
    double limit = 0;
    for (const EffectSlot& other : dry) {
      if (other.at == dry[i].at && rests(other, at.x[other.at])) limit += level(m, other, at.x, f, e, u, t, h);
    }
    const double force = f[dry[i].at] * e[dry[i].at];
    if (std::abs(force) > limit) modes[i] = force > 0 ? Mode::forth : Mode::back;
  }
}

/// The velocity that stops first in a step, and after which share of it.
struct Stop {
  int at = -1;  // none
  double share = 1;
};

template <class State>
Stop first_stop(const EffectSlots& slots, std::span<const Mode> modes, const State& before, const State& after) {
  Stop stop;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const int at = slots.dry[i].at;
    if (modes[i] == Mode::stuck || after[at] * static_cast<double>(modes[i]) >= 0) continue;
    const double share = before[at] == after[at] ? 0 : before[at] / (before[at] - after[at]);
    if (share < stop.share) stop = {at, std::clamp(share, 0.0, 1.0)};
  }
  return stop;
}

}  // namespace surefoot::diagnosis
