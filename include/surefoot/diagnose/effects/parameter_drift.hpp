// A parameter that changes while the machine runs, by heating or wear, t from the first row of each recording; never
// below a twentieth:
//   steadily:  factor = 1 + rate * t
//   settling:  factor = 1 + change * (1 - exp(-t / time)), as what heats up through one thermal resistance does
//   bent:      factor = 1 + rate * t + bend * t^2, any course to second order (Taylor)
//   midway:    factor = 1 + change * (what has come of it: a logistic curve, detail/midway.hpp)
// Confusable with a drifting sensor, and with that parameter being wrong as a whole when recordings are short.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/midway.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

inline constexpr double least_drift_factor = 0.05;  // a parameter that drifts does not vanish, nor change its sign

[[gnu::cold]] inline Effect parameter_drift() {
  return {.name = "parameter_drift",
          .sentence = "parameter {at} changes by a share of {rate}",
          .place = Place::parameter,
          .parameters = parameters_of(
              {{.name = "rate", .measure = {.time = -1}, .low = -20, .high = 20, .starts = {0.001}, .strength = true}}),
          .confusable_with = names_of({"sensor_drift", "supply_sag", "leak"}),
          .experiment = "repeat one and the same motion for as long as the machine runs, without a break",
          .factor = +[](const EffectContext& m, Values p) { return std::max(least_drift_factor, 1 + p[0] * m.time); }};
}

[[gnu::cold]] inline Effect parameter_drift_settling() {
  return {.name = "parameter_drift",
          .sentence = "parameter {at} changes by a share of {change}, settling with a time constant of {time}",
          .place = Place::parameter,
          .parameters =
              parameters_of({{.name = "change", .low = -0.95, .high = 20, .starts = {0.05}, .strength = true},
                             {.name = "time", .measure = {.time = 1}, .low = 0.1, .high = 50, .starts = {0.4, 2}}}),
          .confusable_with = names_of({"sensor_drift", "supply_sag", "leak"}),
          .experiment = "repeat one and the same motion for as long as the machine runs, without a break",
          .form = "settling",
          .factor = +[](const EffectContext& m, Values p) {
            return std::max(least_drift_factor, 1 + p[0] * (1 - std::exp(-m.time / p[1])));
          }};
}

[[gnu::cold]] inline Effect parameter_drift_bent() {
  Effect effect = parameter_drift();
  effect.form = "bent";
  effect.extends = names_of({"", "settling"});
  effect.sentence += " and {bend}";
  effect.parameters.push_back(
      parameters_of(
          {{.name = "bend", .measure = {.time = -2}, .low = -20, .high = 20, .starts = {0.001}, .strength = true}})
          .front());
  effect.factor = +[](const EffectContext& m, Values p) {
    return std::max(least_drift_factor, 1 + (p[0] + p[1] * m.time) * m.time);
  };
  return effect;
}

[[gnu::cold]] inline Effect parameter_drift_midway() {
  Effect effect = parameter_drift();
  effect.form = "midway";
  effect.extends = names_of({"", "settling", "bent"});
  effect.sentence =
      "parameter {at} changes by a share of {change}, half of it by {middle}, most within {width} of that";
  effect.parameters = midway_parameters({}, -0.95, 20, 0.2);
  effect.factor = +[](const EffectContext& m, Values p) {
    return std::max(least_drift_factor, 1 + p[0] * midway(m.time, p[1], p[2]));
  };
  return effect;
}

}  // namespace surefoot::effects
