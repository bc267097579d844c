// A sensor that reads too much or too little by the same amount everywhere: y + bias.
// Confusable with a constant force, with weight off its line, and with a wrong initial state.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect sensor_bias() {
  return {.name = "sensor_bias",
          .sentence = "the sensor {at} reads {bias} too much",
          .place = Place::output,
          .parameters = parameters_of(
              {{.name = "bias", .measure = {.value = 1}, .low = -2, .high = 2, .starts = {0.05}, .strength = true}}),
          .confusable_with = names_of({"constant_force", "gravity_offset", "sensor_drift"}),
          .experiment = "rest in a pose that is known from elsewhere (a tape, a plumb line)",
          .at_start = true,
          .is_constant = true,
          .sensor = +[](const Series& series, Values p) {
            for (double& reading : series.readings) reading += p[0];
          }};
}

}  // namespace surefoot::effects
