// Drag of a fluid: force = -drag * v |v|.
// Newton, Principia, book II, 1687; Batchelor, "An introduction to fluid dynamics", 1967, section 5.11.
// Confusable with viscous friction when only one speed was driven.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect quadratic_drag() {
  return {.name = "quadratic_drag",
          .sentence = "drag that grows with the square of speed, {drag}, at {at}",
          .place = Place::velocity,
          .parameters = parameters_of({{.name = "drag",
                                        .measure = {.effort = 1, .value = -2},
                                        .low = 0,
                                        .high = 5,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"viscous_friction", "coulomb_friction"}),
          .experiment = "let it coast freely from the highest speed down to rest",
          .force = +[](const EffectContext& m, Values p, Values) { return -p[0] * m.value * std::abs(m.value); }};
}

}  // namespace surefoot::effects
