// Viscous friction: force = -damping * v.
// Armstrong-Helouvry, Dupont, Canudas de Wit: "A survey of models, analysis tools and compensation methods for the
// control of machines with friction", Automatica 30(7), 1994, section 2.1.
// Confusable with dry and quadratic friction when only one speed was driven, and with a weaker drive, since the back
// EMF of a motor brakes in the same way.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect viscous_friction() {
  return {.name = "viscous_friction",
          .sentence = "friction that grows with speed, {damping}, at {at}",
          .place = Place::velocity,
          .parameters = parameters_of({{.name = "damping",
                                        .measure = {.effort = 1, .value = -1},
                                        .low = 0,
                                        .high = 5,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"coulomb_friction", "quadratic_drag", "input_gain"}),
          .experiment = "let it coast freely from a few different speeds",
          .force = +[](const EffectContext& m, Values p, Values) { return -p[0] * m.value; }};
}

}  // namespace surefoot::effects
