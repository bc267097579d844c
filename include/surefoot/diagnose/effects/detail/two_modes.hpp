// Two further inertias on the first, each behind a spring and a damper of its own: a joint that swings in two modes.
//
// As in two_masses.hpp, each with its own ratio r, frequency f and share s = r/(1 + r):
//   w' = -pull - a - s2 pull2   (and the other way round),   force = inertia (s pull + s2 pull2),
// a the acceleration of the first by everything else. Linear, so that a step is one map, found in short substeps by the
// semi-implicit Euler method, with implicit dampers. Hidden states: d, w, d2, w2, last speed of the first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "surefoot/diagnose/effects/detail/two_masses.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

struct TwoModes {
  std::array<double, 2> ratio = {0, 0};
  std::array<double, 2> frequency = {1, 1};  // [rad/s], each against the first inertia alone
  double damping = 0;                        // share of the critical one, of both
};

/// d, w, d2, w2 of two_modes.hpp.
using Swings = std::array<double, 4>;

/// The linear map of the offsets over a step: what they are after it for each of them at 1 before, and for a = 1.
struct TwoModesMap {
  std::array<double, 2> share;
  double step = 0;
  std::array<Swings, 5> by = {};

  Swings after(Values at, double a) const {
    Swings result = {};
    for (std::size_t k = 0; k < result.size(); ++k) {
      result[k] = by[4][k] * a;
      for (std::size_t j = 0; j < result.size(); ++j) result[k] += by[j][k] * at[j];
    }
    return result;
  }

  /// Mean acceleration of the first by springs and dampers during a step, from what became of both speeds.
  double mean_acceleration(Values at, double a) const {
    const Swings end = after(at, a);
    const double first = (at[1] - end[1]) / step - a, second = (at[3] - end[3]) / step - a;
    const double by_first = first - share[1] * second, by_second = second - share[0] * first;
    return (share[0] * by_first + share[1] * by_second) / (1 - share[0] * share[1]);
  }
};

inline TwoModesMap two_modes_map(const TwoModes& modes, double step) {
  TwoModesMap map;
  map.step = step;
  std::array<double, 2> f, damp;
  for (std::size_t i = 0; i < f.size(); ++i) {
    f[i] = std::min(modes.frequency[i], 2 / step);
    map.share[i] = modes.ratio[i] / (1 + modes.ratio[i]);
  }
  const int substeps = swing_substeps(std::max(f[0], f[1]), step);
  const double h = step / substeps;
  for (std::size_t i = 0; i < f.size(); ++i) damp[i] = 2 * h * modes.damping * f[i];
  const double s = map.share[0], s2 = map.share[1];
  const double determinant = (1 + damp[0]) * (1 + damp[1]) - s * s2 * damp[0] * damp[1];
  for (std::size_t k = 0; k < map.by.size(); ++k) {
    Swings& at = map.by[k];
    if (k < at.size()) at[k] = 1;
    const double a = k < at.size() ? 0 : 1;
    for (int i = 0; i < substeps; ++i) {
      const double spring = f[0] * f[0] * at[0], spring2 = f[1] * f[1] * at[2];
      const double w = at[1] - h * (spring + a + s2 * spring2), w2 = at[3] - h * (spring2 + a + s * spring);
      at[1] = ((1 + damp[1]) * w - s2 * damp[1] * w2) / determinant;
      at[3] = ((1 + damp[0]) * w2 - s * damp[0] * w) / determinant;
      at[0] += h * at[1];
      at[2] += h * at[3];
    }
  }
  return map;
}

/// The same, which all stages of a run, mostly, ask for with the same values.
inline const TwoModesMap& last_two_modes_map(const TwoModes& modes, double step) {
  thread_local TwoModes of;
  thread_local TwoModesMap map;
  if (map.step != step || of.ratio != modes.ratio || of.frequency != modes.frequency || of.damping != modes.damping) {
    map = two_modes_map(modes, step);
    of = modes;
  }
  return map;
}

inline double force_of(const TwoModes& modes, const EffectContext& m, Values hidden) {
  return m.step > 0 ? m.effort * last_two_modes_map(modes, m.step).mean_acceleration(hidden, m.rate) : 0;
}

/// As that of two masses: the speed of the first tells which acceleration by everything else it really had.
inline void advance(const TwoModes& modes, const EffectContext& m, HiddenStates hidden) {
  if (!(m.step > 0)) return;
  const TwoModesMap& map = last_two_modes_map(modes, m.step);
  const double total = (m.value - hidden[4]) / m.step;
  const double at_rest = map.mean_acceleration(hidden, 0), slope = 1 + map.mean_acceleration(hidden, 1) - at_rest;
  const double a = slope > 0.05 ? (total - at_rest) / slope : total;
  const Swings after = map.after(hidden, a);
  for (std::size_t k = 0; k < after.size(); ++k) hidden[k] = after[k];
  hidden[4] = m.value;
}

}  // namespace surefoot::effects
