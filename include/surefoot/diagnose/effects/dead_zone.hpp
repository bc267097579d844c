// A dead zone of the input: nothing happens within +-width, beyond it counts what exceeds it,
//   sign(u) max(|u| - width, 0).
// Form "step": beyond it the whole input counts (the edge is softened over a fifth of the width, so that fits can
// follow it).
// G. Tao, P. V. Kokotovic: "Adaptive control of systems with actuator and sensor nonlinearities", 1996, chapter 2.
// Confusable with dry friction, which swallows small forces too, and with a lower gain when the input is always large.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// What exceeds a dead zone of this width to either side.
inline double beyond_dead_zone(double value, double width) {
  return std::max(value - width, 0.0) + std::min(value + width, 0.0);
}

[[gnu::cold]] inline Effect dead_zone() {
  return {.name = "dead_zone",
          .sentence = "a dead zone of {width} to either side of {at}",
          .place = Place::input,
          .parameters = parameters_of({{.name = "width",
                                        .measure = {.value = 1},
                                        .low = 0,
                                        .high = 2,
                                        .starts = {0.003, 0.05, 0.2},
                                        .strength = true}}),
          .confusable_with = names_of({"coulomb_friction", "input_gain", "backlash"}),
          .experiment = "small inputs that grow slowly from zero, both ways",
          .signal = +[](const EffectContext& m, Values p, Values) { return beyond_dead_zone(m.value, p[0]); }};
}

[[gnu::cold]] inline Effect dead_zone_step() {
  return {.name = "dead_zone",
          .sentence = "{at} does nothing below {width} to either side",
          .place = Place::input,
          .parameters = parameters_of({{.name = "width",
                                        .measure = {.value = 1},
                                        .low = 0.01,
                                        .high = 2,
                                        .starts = {0.1, 0.3, 0.6},
                                        .beyond_least = true}}),
          .confusable_with = names_of({"coulomb_friction", "backlash"}),
          .experiment = "small inputs that grow slowly from zero, both ways",
          .form = "step",
          .needs_small_values = true,
          .signal = +[](const EffectContext& m, Values p, Values) {
            const double edge = std::clamp((std::abs(m.value) / p[0] - 0.9) / 0.2, 0.0, 1.0);
            return m.value * edge * edge * (3 - 2 * edge);
          }};
}

}  // namespace surefoot::effects
