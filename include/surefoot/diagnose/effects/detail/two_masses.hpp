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

/// The offset after a time `step` of constant acceleration a, by the semi-implicit Euler method. Frequencies beyond
/// 2/step are taken for that: they cannot be told apart.
inline Offset swing(const TwoMasses& masses, Offset at, double a, double step) {
  const double frequency = std::min(masses.frequency, 2 / step);
  const int substeps = 1 + static_cast<int>(frequency * step / 0.1);
  const double h = step / substeps, damping = 2 * masses.damping * frequency;
  if (masses.half_width == 0) {  // linear
    const double keep = 1 / (1 + h * damping), bend = keep * h * frequency * frequency, push = keep * h * a;
    for (int i = 0; i < substeps; ++i) {
      at.w = (keep * at.w - push) - bend * at.d;
      at.d += h * at.w;
    }
    return at;
  }
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
