// A sensor whose zero wanders, t from the first row:
//   steadily:  y + rate * t
//   settling:  y + change * (1 - exp(-t / time)), as while it warms up
//   bent:      y + rate * t + bend * t^2, any course to second order (Taylor)
//   midway:    y + change * (what has come of it: a logistic curve, detail/midway.hpp)
// Confusable with a constant rate or a leak of what it reads, and with a drifting parameter.
#pragma once

#include <cmath>
#include <cstddef>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/midway.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect sensor_drift() {
  return {.name = "sensor_drift",
          .sentence = "the sensor {at} drifts by {rate}",
          .place = Place::output,
          .parameters = parameters_of({{.name = "rate",
                                        .measure = {.value = 1, .time = -1},
                                        .low = -20,
                                        .high = 20,
                                        .starts = {0.01},
                                        .strength = true}}),
          .confusable_with = names_of({"constant_rate", "leak", "sensor_bias", "parameter_drift"}),
          .experiment = "rest for as long as a recording lasts, in a pose known from elsewhere",
          .sensor = +[](const Series& series, Values p) {
            for (std::size_t row = 0; row < series.readings.size(); ++row) {
              series.readings[row] += p[0] * (series.time[row] - series.time[0]);
            }
          }};
}

[[gnu::cold]] inline Effect sensor_drift_settling() {
  return {.name = "sensor_drift",
          .sentence = "the sensor {at} drifts by {change}, settling with a time constant of {time}",
          .place = Place::output,
          .parameters = parameters_of(
              {{.name = "change", .measure = {.value = 1}, .low = -2, .high = 2, .starts = {0.03}, .strength = true},
               {.name = "time", .measure = {.time = 1}, .low = 0.1, .high = 50, .starts = {0.4, 2}}}),
          .confusable_with = names_of({"constant_rate", "leak", "sensor_bias", "parameter_drift"}),
          .experiment = "rest for as long as a recording lasts, in a pose known from elsewhere",
          .form = "settling",
          .sensor = +[](const Series& series, Values p) {
            for (std::size_t row = 0; row < series.readings.size(); ++row) {
              series.readings[row] += p[0] * (1 - std::exp(-(series.time[row] - series.time[0]) / p[1]));
            }
          }};
}

[[gnu::cold]] inline Effect sensor_drift_bent() {
  Effect effect = sensor_drift();
  effect.form = "bent";
  effect.extends = names_of({"", "settling"});
  effect.sentence += " and {bend}";
  effect.parameters.push_back(parameters_of({{.name = "bend",
                                              .measure = {.value = 1, .time = -2},
                                              .low = -20,
                                              .high = 20,
                                              .starts = {0.01},
                                              .strength = true}})
                                  .front());
  effect.sensor = +[](const Series& series, Values p) {
    for (std::size_t row = 0; row < series.readings.size(); ++row) {
      const double time = series.time[row] - series.time[0];
      series.readings[row] += (p[0] + p[1] * time) * time;
    }
  };
  return effect;
}

[[gnu::cold]] inline Effect sensor_drift_midway() {
  Effect effect = sensor_drift();
  effect.form = "midway";
  effect.extends = names_of({"", "settling", "bent"});
  effect.sentence = "the sensor {at} drifts by {change}, half of it by {middle}, most within {width} of that";
  effect.parameters = midway_parameters({.value = 1}, -2, 2, 0.1);
  effect.sensor = +[](const Series& series, Values p) {
    for (std::size_t row = 0; row < series.readings.size(); ++row) {
      series.readings[row] += p[0] * midway(series.time[row] - series.time[0], p[1], p[2]);
    }
  };
  return effect;
}

}  // namespace surefoot::effects
