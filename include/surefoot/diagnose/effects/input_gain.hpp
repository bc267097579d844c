// An input that acts more or less than ordered: u (1 + excess).
// Confusable with any parameter of the model that scales the same force (a motor constant, an inertia).
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect input_gain() {
  return {.name = "input_gain",
          .sentence = "the gain of {at} is off by {excess} of its value",
          .place = Place::input,
          .parameters = parameters_of(
              {{.name = "excess", .measure = {}, .low = -0.95, .high = 3, .starts = {0.003, 0.1}, .strength = true}}),
          .confusable_with = names_of({"input_asymmetry", "dead_zone", "supply_sag", "viscous_friction"}),
          .experiment = "steps of the input of several sizes, both ways",
          .signal = +[](const EffectContext& m, Values p, Values) { return m.value * (1 + p[0]); }};
}

}  // namespace surefoot::effects
