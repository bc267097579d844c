// A sensor that reads in steps: y rounded to multiples of `step`. The edges are softened (a tenth of a step from the
// edge, the error is a quarter of one), so that fits of the model can pass through them.
// B. Widrow, I. Kollar: "Quantization noise", 2008, chapter 1.
// Form "floor": rounded down. Confusable with backlash before the sensor, and with plain noise when the steps are
// small.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/effect.hpp"

namespace surefoot::effects {

/// Rounds to the nearest integer, with soft edges. Keeps integers, is monotone.
inline double soft_round(double x) {
  constexpr double sharpness = 8;
  const double below = std::floor(x);
  return below + 0.5 + 0.5 * std::tanh(sharpness * (x - below - 0.5)) / std::tanh(0.5 * sharpness);
}

/// The largest step whose multiples the readings crowd around, if there is one: the mean of exp(2 pi i y / step) over
/// readings from all parts of the range (Rayleigh's test of a direction). Empty: no such step above 1/1000 of the
/// range.
inline std::vector<double> lattice_steps(Values readings) {
  if (readings.size() < 100) return {};
  const auto [low, high] = std::minmax_element(readings.begin(), readings.end());
  const double least = *low, range = *high - *low;
  if (!(range > 0)) return {};
  constexpr std::size_t parts = 300;
  std::vector<double> kept(parts), seen(parts);  // one reading of each part of the range, any with equal probability
  Rng rng(1);
  for (const double reading : readings) {
    const auto part = std::min(parts - 1, static_cast<std::size_t>((reading - least) / range * parts));
    if (rng.uniform() * ++seen[part] < 1) kept[part] = reading;
  }
  std::vector<double> one_per_part;
  for (std::size_t part = 0; part < parts; ++part) {
    if (seen[part] > 0) one_per_part.push_back(kept[part]);
  }
  if (one_per_part.size() < 8) return {};
  const auto crowding = [&](double step) {
    double cosine = 0, sine = 0;
    for (const double reading : one_per_part) {
      const double angle = 2 * std::numbers::pi * reading / step;
      cosine += std::cos(angle);
      sine += std::sin(angle);
    }
    return std::hypot(cosine, sine) / static_cast<double>(one_per_part.size());
  };
  // Directions of all readings, turned on from one frequency to the next.
  std::vector<std::complex<double>> direction, turn;
  for (const double reading : one_per_part) {
    const double at = 2 * std::numbers::pi * (reading - least) / range;
    direction.push_back(std::polar(1.0, 6 * at));
    turn.push_back(std::polar(1.0, 0.1 * at));
  }
  const auto count = static_cast<double>(one_per_part.size());
  for (double frequency = 6; frequency < 1000; frequency += 0.1) {  // steps in the range
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < direction.size(); ++i) {
      sum += direction[i];
      direction[i] *= turn[i];
    }
    double share = std::abs(sum) / count, step = range / frequency;
    if (share < 0.5 || share * share * count < 25) continue;
    for (double width = 0.1 / frequency; width > 1e-5; width *= 0.5) {  // uphill to the top of the peak
      for (const double next : {step * (1 - width), step * (1 + width)}) {
        const double there = crowding(next);
        if (there <= share) continue;
        share = there;
        step = next;
      }
    }
    return {step};
  }
  return {};
}

inline Effect quantization() {
  return {.name = "quantization",
          .sentence = "the sensor {at} reads in steps of {step}",
          .place = Place::output,
          .parameters = {{.name = "step",
                          .measure = {.value = 1},
                          .low = 0.001,
                          .high = 2,
                          .starts = {0.01, 0.03, 0.1, 0.2, 0.4, 0.8}}},
          .confusable_with = {"backlash"},
          .experiment = "the slowest motion possible through many steps of the sensor",
          .suggest = lattice_steps,
          .sensor = [](const Series& series, Values p) {
            for (double& reading : series.readings) reading = p[0] * soft_round(reading / p[0]);
          }};
}

/// The same for a converter that cuts off instead of rounding.
inline Effect quantization_floor() {
  Effect effect = quantization();
  effect.form = "floor";
  effect.sensor = [](const Series& series, Values p) {
    for (double& reading : series.readings) reading = p[0] * soft_round(reading / p[0] - 0.5);
  };
  return effect;
}

}  // namespace surefoot::effects
