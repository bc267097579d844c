// An input that acts more to one side: u (1 + asymmetry) for u > 0, u (1 - asymmetry) for u < 0.
// Confusable with a constant force (when the input is always about as large) and with a gain (when it is one-sided).
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect input_asymmetry() {
  return {
      .name = "input_asymmetry",
      .sentence =
          "an asymmetry of {asymmetry} at {at}: 1 plus that of its positive values acts, and 1 minus that of its "
          "negative ones",
      .place = Place::input,
      .parameters = parameters_of(
          {{.name = "asymmetry", .measure = {}, .low = -0.95, .high = 0.95, .starts = {0.003, 0.1}, .strength = true}}),
      .confusable_with = names_of({"constant_force", "input_gain", "body_drift", "sensor_bias"}),
      .experiment = "the same steps of the input to either side, in two sizes",
      .needs_both_signs = true,
      .signal =
          +[](const EffectContext& m, Values p, Values) { return m.value * (m.value > 0 ? 1 + p[0] : 1 - p[0]); }};
}

}  // namespace surefoot::effects
