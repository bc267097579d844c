// Dry (Coulomb) friction: a force `level` against the motion, or up to `level` that holds it at rest.
// Armstrong-Helouvry, Dupont, Canudas de Wit: "A survey of models, analysis tools and compensation methods for the
// control of machines with friction", Automatica 30(7), 1994, section 2.1.
// Confusable with Stribeck friction when nothing moves slowly, with friction that grows with the load when the load
// never changes, and with hysteresis and a dead zone, which also swallow small motions.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect coulomb_friction() {
  return {
      .name = "coulomb_friction",
      .sentence = "dry friction of {level} at {at}",
      .place = Place::velocity,
      .parameters = parameters_of(
          {{.name = "level", .measure = {.effort = 1}, .low = 0, .high = 3, .starts = {0.003, 0.1}, .strength = true}}),
      .confusable_with =
          names_of({"stribeck_friction", "load_dependent_friction", "hysteresis", "viscous_friction", "dead_zone"}),
      .experiment = "a slow ramp with reversals, at a few speeds down to the slowest that still moves",
      .dry = +[](const EffectContext&, Values p) { return p[0]; }};
}

}  // namespace surefoot::effects
