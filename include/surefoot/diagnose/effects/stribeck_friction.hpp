// Dry friction that is larger near rest: level(v) = level + breakaway * exp(-|v/speed|^2). Form "tailed": another
// exponent than 2, between 0.4 (a long tail towards high speeds) and 2.
// R. Stribeck, 1902; in this form L. C. Bo, D. Pavelescu: "The friction-speed relation and its influence on the
// critical velocity of stick-slip motion", Wear 82, 1982. Confusable with plain dry friction as long as the motion is
// fast against `speed`, and with friction that grows with the load, since joints are often slow where the load is
// largest.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect stribeck_friction() {
  return {
      .name = "stribeck_friction",
      .sentence = "dry friction of {level} and another {breakaway} near rest (below {speed}) at {at}",
      .place = Place::velocity,
      .parameters = parameters_of(
          {{.name = "level", .measure = {.effort = 1}, .low = 0, .high = 3, .starts = {0.003, 0.1}, .strength = true},
           {.name = "breakaway",
            .measure = {.effort = 1},
            .low = 0,
            .high = 3,
            .starts = {0.003, 0.1},
            .strength = true},
           {.name = "speed", .measure = {.value = 1}, .low = 0.005, .high = 2, .starts = {0.03, 0.1, 0.4}}}),
      .confusable_with = names_of({"coulomb_friction", "load_dependent_friction", "hysteresis"}),
      .experiment =
          "slow ramps with reversals at several speeds, from crawling to fast: the force needed falls with "
          "speed",
      .dry = +[](const EffectContext& m, Values p) {
        const double ratio = m.value / p[2];
        return p[0] + p[1] * std::exp(-ratio * ratio);
      }};
}

[[gnu::cold]] inline Effect stribeck_friction_tailed() {
  Effect effect = stribeck_friction();
  effect.sentence += ", falling with the power {exponent} of speed";
  effect.parameters.push_back({.name = "exponent", .low = 0.4, .high = 2, .starts = {0.8}});
  effect.form = "tailed";
  effect.dry = +[](const EffectContext& m, Values p) {
    return p[0] + p[1] * std::exp(-std::pow(std::abs(m.value) / p[2], p[3]));
  };
  return effect;
}

}  // namespace surefoot::effects
