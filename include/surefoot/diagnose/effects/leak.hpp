// A leak: the state falls the faster the more there is of it, rate = -leak * x.
// Form "hole": through an opening at the bottom, rate = -rate_at_one * sqrt(x), x in units of the model (E. Torricelli,
// "Opera geometrica", 1644); nothing leaks below 0. Form "power": rate = -rate_at_one * x^exponent, 1/2 for a hole, 1
// where it is all friction, between them for cracks and slits, above them for notches (ASTM E779; J. M. Weisbach).
// Confusable with a constant loss when x hardly changes, and with a weaker inflow when it settles.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect leak() {
  return {.name = "leak",
          .sentence = "a leak that grows with {at}, {leak}",
          .place = Place::state,
          .parameters = parameters_of({{.name = "leak",
                                        .measure = {.effort = 1, .value = -1},
                                        .low = 0,
                                        .high = 3,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"constant_rate", "input_gain", "overflow"}),
          .experiment = "fill it up, stop every input and record the decay until little is left",
          .needs_conserved_state = true,
          .force = +[](const EffectContext& m, Values p, Values) { return -p[0] * m.value; }};
}

[[gnu::cold]] inline Effect leak_hole() {
  return {.name = "leak",
          .sentence = "a leak through a hole, {rate_at_one} at level 1, at {at}",
          .place = Place::state,
          .parameters = parameters_of({{.name = "rate_at_one",
                                        .measure = {.effort = 1},
                                        .low = 0,
                                        .high = 10,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"constant_rate", "input_gain", "overflow"}),
          .experiment = "fill it up, stop every input and record the decay until little is left",
          .form = "hole",
          .needs_conserved_state = true,
          .force = +[](const EffectContext& m, Values p, Values) { return -p[0] * std::sqrt(std::max(m.value, 0.0)); }};
}

[[gnu::cold]] inline Effect leak_power() {
  Effect effect = leak_hole();
  effect.form = "power";
  effect.extends = names_of({"", "hole"});
  effect.sentence += ", with the power {exponent} of it";
  effect.parameters.push_back(parameters_of({{.name = "exponent", .low = 0.3, .high = 3, .starts = {0.7}}}).front());
  effect.force =
      +[](const EffectContext& m, Values p, Values) { return -p[0] * std::pow(std::max(m.value, 0.0), p[1]); };
  return effect;
}

}  // namespace surefoot::effects
