// A parameter that changes while the machine runs, by heating or wear: factor = 1 + rate * t, t from the first row of
// each recording; never below a twentieth.
// Confusable with a drifting sensor, and with that parameter being wrong as a whole when recordings are short.
#pragma once

#include <algorithm>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

inline Effect parameter_drift() {
  return {.name = "parameter_drift",
          .sentence = "parameter {at} changes by a share of {rate}",
          .place = Place::parameter,
          .parameters = parameters_of(
              {{.name = "rate", .measure = {.time = -1}, .low = -20, .high = 20, .starts = {0.001}, .strength = true}}),
          .confusable_with = names_of({"sensor_drift", "supply_sag", "leak"}),
          .experiment = "repeat one and the same motion for as long as the machine runs, without a break",
          .factor = +[](const EffectContext& m, Values p) { return std::max(0.05, 1 + p[0] * m.time); }};
}

}  // namespace surefoot::effects
