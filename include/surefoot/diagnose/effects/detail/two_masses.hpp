// A second inertia behind a spring and a damper, which may have a gap: what an elastic joint and a gap share.
//
// The second inertia is `ratio` times the first; d is its offset from it, w = d' its speed against it, a the
// acceleration of the first by everything else:
//   w' = -pull - a,   pull = f (f bend(d) + 2 damping w) in contact, else 0,   force = inertia ratio/(1 + ratio) pull,
// f the frequency at which the two swing against each other. Solved in short substeps of its own within each step, so
// that it is stable whatever integrates the simulator. Hidden states: d, w, speed of the first after the last step.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// By how much `offset` exceeds a gap of half_width, with its sign; 0 inside.
inline double beyond_gap(double offset, double half_width) {
  return std::max(offset - half_width, 0.0) + std::min(offset + half_width, 0.0);
}

struct TwoMasses {
  double ratio = 0;
  double frequency = 1;   // [rad/s]
  double damping = 0;     // share of the critical one
  double half_width = 0;  // of the gap; 0: always in contact
};

struct Offset {
  double d = 0, w = 0;
};

/// Substeps that a swing of this frequency [rad/s] needs within a step [s]: of a tenth of a radian.
inline int swing_substeps(double frequency, double step) { return 1 + static_cast<int>(frequency * step / 0.1); }

/// The linear map of an offset over a step, d and w after it by d, w and a before.
struct SwingMap {
  Offset by_d, by_w, by_a;
};

inline SwingMap swing_map(double frequency, double damping, double step) {
  const int substeps = swing_substeps(frequency, step);
  const double h = step / substeps, keep = 1 / (1 + 2 * h * damping * frequency);
  const auto after = [&](Offset at, double a) {
    for (int i = 0; i < substeps; ++i) {
      at.w = keep * (at.w - h * (frequency * frequency * at.d + a));
      at.d += h * at.w;
    }
    return at;
  };
  return {after({1, 0}, 0), after({0, 1}, 0), after({0, 0}, 1)};
}

/// The same, which all stages of a run, mostly, ask for with the same values.
inline const SwingMap& last_swing_map(double frequency, double damping, double step) {
  thread_local double of[3] = {0, 0, 0};
  thread_local SwingMap map;
  if (of[0] != frequency || of[1] != damping || of[2] != step) {
    map = swing_map(frequency, damping, step);
    of[0] = frequency, of[1] = damping, of[2] = step;
  }
  return map;
}

/// The offset after a time `step` of constant acceleration a, by the semi-implicit Euler method. Frequencies beyond
/// 2/step are taken for that: they cannot be told apart.
inline Offset swing(const TwoMasses& masses, Offset at, double a, double step) {
  const double frequency = std::min(masses.frequency, 2 / step);
  if (masses.half_width == 0) {  // linear
    const SwingMap& map = last_swing_map(frequency, masses.damping, step);
    return {map.by_d.d * at.d + map.by_w.d * at.w + map.by_a.d * a,
            map.by_d.w * at.d + map.by_w.w * at.w + map.by_a.w * a};
  }
  const int substeps = swing_substeps(frequency, step);
  const double h = step / substeps, damping = 2 * masses.damping * frequency;
  for (int i = 0; i < substeps; ++i) {
    const double bend = beyond_gap(at.d, masses.half_width);
    // parts in contact push and never pull
    const double pull = frequency * frequency * bend + (bend != 0 ? damping * at.w : 0.0);
    at.w -= h * ((pull * bend > 0 ? pull : 0.0) + a);
    at.d += h * at.w;
  }
  return at;
}

/// Mean of `pull` over a step.
inline double mean_pull(const TwoMasses& masses, const Offset& at, double a, double step) {
  return (at.w - swing(masses, at, a, step).w) / step - a;
}

inline double force_of(const TwoMasses& masses, const EffectContext& m, Values hidden) {
  if (!(m.step > 0)) return 0;
  const double share = masses.ratio / (1 + masses.ratio);
  return m.effort * share * mean_pull(masses, {hidden[0], hidden[1]}, m.rate, m.step);
}

/// After a step the speed of the first tells which acceleration it really had, held by dry friction or not; it is found
/// by one step of the secant method, exact without a gap.
inline void advance(const TwoMasses& masses, const EffectContext& m, HiddenStates hidden) {
  if (!(m.step > 0)) return;
  const Offset before{hidden[0], hidden[1]};
  const double share = masses.ratio / (1 + masses.ratio), total = (m.value - hidden[2]) / m.step;
  const auto miss = [&](double a) { return a + share * mean_pull(masses, before, a, m.step) - total; };
  const double first = total, miss_first = miss(first);
  double a = first - miss_first;
  const double slope = a == first ? 1 : (miss(a) - miss_first) / (a - first);
  if (slope > 0.05) a = first - miss_first / slope;
  const Offset after = swing(masses, before, a, m.step);
  hidden[0] = after.d;
  hidden[1] = after.w;
  hidden[2] = m.value;
}

inline void start(const EffectContext& m, HiddenStates hidden) {
  hidden[0] = hidden[1] = 0;
  hidden[2] = m.value;
}

}  // namespace surefoot::effects
