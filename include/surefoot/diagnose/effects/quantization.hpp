// A sensor that reads in steps: y rounded to multiples of `step`. The edges are softened (a tenth of a step from the
// edge, the error is a quarter of one), so that fits of the model can pass through them; so does noise before the
// converter. B. Widrow, I. Kollar: "Quantization noise", 2008, chapter 1.
// Form "floor": rounded down. Forms "sharp": edges ten times sharper, of steps well above that noise. Confusable with
// backlash before the sensor, and with plain noise when the steps are small.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/sensor_steps.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

inline constexpr double soft_edge = 8, sharp_edge = 80;  // steepness in the middle between two integers

/// Rounds to the nearest integer, with soft edges. Keeps integers, is monotone.
inline double soft_round(double x, double sharpness = soft_edge) {
  const double below = std::floor(x);
  return below + 0.5 + 0.5 * std::tanh(sharpness * (x - below - 0.5)) / std::tanh(0.5 * sharpness);
}

[[gnu::cold]] inline Effect quantization() {
  return {.name = "quantization",
          .sentence = "the sensor {at} reads in steps of {step}",
          .place = Place::output,
          .parameters = parameters_of({{.name = "step",
                                        .measure = {.value = 1},
                                        .low = 0.001,
                                        .high = 2,
                                        .starts = {0.01, 0.03, 0.1, 0.2, 0.4, 0.8}}}),
          .confusable_with = names_of({"backlash"}),
          .experiment = "the slowest motion possible through many steps of the sensor",
          .needs_suggestion = true,
          .rounds = true,
          .suggest = +[](Values readings, Values simulated) { return sensor_steps(readings, simulated); },
          .sensor =
              +[](const Series& series, Values p) {
                for (double& reading : series.readings) reading = p[0] * soft_round(reading / p[0]);
              }};
}

/// The same for a converter that cuts off instead of rounding.
[[gnu::cold]] inline Effect quantization_floor() {
  Effect effect = quantization();
  effect.form = "floor";
  effect.sensor = +[](const Series& series, Values p) {
    for (double& reading : series.readings) reading = p[0] * soft_round(reading / p[0] - 0.5);
  };
  return effect;
}

/// With sharp edges, where soft ones were found.
[[gnu::cold]] inline Effect sharpened(Effect quantization) {
  const double shift = quantization.form == "floor" ? 0.5 : 0;
  quantization.extends = {quantization.form};
  quantization.form += quantization.form.empty() ? "sharp" : ", sharp";
  quantization.needs_suggestion = false;
  quantization.suggest = {};
  quantization.sensor = [shift](const Series& series, Values p) {
    for (double& reading : series.readings) reading = p[0] * soft_round(reading / p[0] - shift, sharp_edge);
  };
  return quantization;
}

}  // namespace surefoot::effects
