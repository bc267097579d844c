// A sensor with a wrong scale: y (1 + excess), about zero.
// Confusable with a gain of the input, and with any parameter that makes all motions larger.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect sensor_scale() {
  return {.name = "sensor_scale",
          .sentence = "the scale of the sensor {at} is off by {excess} of its value",
          .place = Place::output,
          .parameters = parameters_of(
              {{.name = "excess", .measure = {}, .low = -0.95, .high = 2, .starts = {0.05}, .strength = true}}),
          .confusable_with = names_of({"input_gain", "sensor_bias"}),
          .experiment = "rest in two poses far apart that are known from elsewhere",
          .at_start = true,
          .sensor = +[](const Series& series, Values p) {
            for (double& reading : series.readings) reading *= 1 + p[0];
          }};
}

}  // namespace surefoot::effects
