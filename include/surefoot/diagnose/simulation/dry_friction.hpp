// Dry friction in a step: neither smoothed nor stiff. Each velocity slides in one direction or sticks for the whole
// step, which is cut where one of them would reverse.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulation/input_signal.hpp"
#include "surefoot/diagnose/simulation/rates.hpp"
#include "surefoot/optimize/coupled_dry_friction.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

inline bool rests(const EffectSlot& slot, double velocity) { return !(std::abs(velocity) > 1e-12 * slot.size); }

/// Decides modes of velocities that rest and are coupled by the mass matrix: what holds one of them pushes the others.
/// `f` are the rates without dry friction, `limit_at` gives how much of it there can be at a velocity.
template <Simulator S, class LimitAt>
void decide_together(AugmentedSimulator<S>& m, const Point<S>& at, typename S::State f,
                     const ForceResponse<S>& response, LimitAt&& limit_at, const typename S::Input& u, double t,
                     double h, std::vector<Mode>& modes) {
  const auto& dry = m.slots.dry;
  const auto without = copied(f);
  std::vector<int> resting;
  for (std::size_t i = 0; i < dry.size(); ++i) {
    if (number_of_pushed(m.structure, dry[i].at) < 0) continue;
    if (modes[i] != Mode::stuck) {
      push(m, response, dry[i].at, -static_cast<double>(modes[i]) * level(m, dry[i], at.x, without, response, u, t, h),
           f);
    } else if (std::find(resting.begin(), resting.end(), dry[i].at) == resting.end()) {
      resting.push_back(dry[i].at);
    }
  }
  if (resting.empty()) return;
  const auto n = static_cast<Eigen::Index>(resting.size());
  Eigen::VectorXd rate(n), limit(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    rate[k] = f[resting[static_cast<std::size_t>(k)]];
    limit[k] = limit_at(resting[static_cast<std::size_t>(k)]);
  }
  const Eigen::MatrixXd mass = surefoot::detail::invert_symmetric(responses_among(m, response, resting));
  CoupledDryFriction work;
  Eigen::VectorXd next;  // the rates that friction leaves: 0 where it holds
  solve_coupled_dry_friction(mass, surefoot::detail::product(mass, rate), limit, work, next);
  for (std::size_t i = 0; i < dry.size(); ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      if (dry[i].at != resting[static_cast<std::size_t>(k)] || next[k] == 0) continue;
      modes[i] = next[k] > 0 ? Mode::forth : Mode::back;
    }
  }
}

/// Sliding or stuck, by dry friction, from the beginning of a step on. Those of one velocity add up.
template <Simulator S>
void decide_modes(AugmentedSimulator<S>& m, const Point<S>& at, const InputSignal<typename S::Input>& inputs, double t,
                  double h, std::vector<Mode>& modes) {
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
  const ForceResponse<S> response = force_response(m, at.x, u);
  const auto limit_at = [&](int velocity) {
    double limit = 0;
    for (const EffectSlot& other : dry) {
      if (other.at == velocity && rests(other, at.x[other.at])) limit += level(m, other, at.x, f, response, u, t, h);
    }
    return limit;
  };
  if constexpr (has_response<S>) {
    if (!m.structure.pushed.empty()) decide_together(m, at, f, response, limit_at, u, t, h, modes);
  }
  for (std::size_t i = 0; i < dry.size(); ++i) {
    if (!rests(dry[i], at.x[dry[i].at]) || number_of_pushed(m.structure, dry[i].at) >= 0) continue;
    const double force = f[dry[i].at] * response.effort[dry[i].at];
    if (std::abs(force) > limit_at(dry[i].at)) modes[i] = force > 0 ? Mode::forth : Mode::back;
  }
}

/// The velocity that stops first in a step, and after which share of it.
struct Stop {
  int at = -1;  // none
  double share = 1;
};

template <class State>
Stop first_stop(const EffectSlots& slots, const std::vector<Mode>& modes, const State& before, const State& after) {
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
