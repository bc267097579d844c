// A gain or loss that never changes: rate + rate0.
// Confusable with a leak when the state hardly changes, and with a drift of its sensor.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect constant_rate() {
  return {
      .name = "constant_rate",
      .sentence = "a constant change of {rate} at {at}",
      .place = Place::state,
      .parameters = parameters_of(
          {{.name = "rate", .measure = {.effort = 1}, .low = -3, .high = 3, .starts = {0.003, 0.1}, .strength = true}}),
      .confusable_with = names_of({"leak", "sensor_drift", "input_gain"}),
      .experiment = "stop every input at a low and at a high level and wait",
      .is_constant = true,
      .force = +[](const EffectContext&, Values p, Values) { return p[0]; }};
}

}  // namespace surefoot::effects
