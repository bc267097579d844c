// Steps in which a sensor may read: from readings that crowd around multiples of a step or, where noise behind the
// converter hides that, from errors that swing with the steps over the simulated values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// Waves over readings, whose sum at one frequency after the other is asked for: their directions, and by how much each
/// turns on.
struct TurningWaves {
  std::vector<double> cosines, sines, turn_cosines, turn_sines;

  void add(double size, double phase, double turn) {
    cosines.push_back(size * std::cos(phase));
    sines.push_back(size * std::sin(phase));
    turn_cosines.push_back(std::cos(turn));
    turn_sines.push_back(std::sin(turn));
  }
  /// Length of the sum at this frequency; all turn on to the next one.
  double next_sum() {
    double cosine = 0, sine = 0;
    for (std::size_t i = 0; i < cosines.size(); ++i) {
      cosine += cosines[i];
      sine += sines[i];
      const double turned = cosines[i] * turn_cosines[i] - sines[i] * turn_sines[i];
      sines[i] = cosines[i] * turn_sines[i] + sines[i] * turn_cosines[i];
      cosines[i] = turned;
    }
    return std::hypot(cosine, sine);
  }
};

/// The largest step whose multiples the readings crowd around, if there is one: the mean of exp(2 pi i y / step) over
/// readings from all parts of the range (Rayleigh's test of a direction). Empty: no such step above 1/1000 of the
/// range.
[[gnu::cold]] inline std::vector<double> lattice_steps(Values readings) {
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
  TurningWaves waves;
  for (const double reading : one_per_part) {
    const double at = 2 * std::numbers::pi * (reading - least) / range;
    waves.add(1, 6 * at, 0.1 * at);
  }
  const auto count = static_cast<double>(one_per_part.size());
  for (double frequency = 6; frequency < 1000; frequency += 0.1) {  // steps in the range
    double share = waves.next_sum() / count, step = range / frequency;
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

/// How much each value counts so that all parts of the range in which there are some count alike: the many readings of
/// a machine at rest say little about steps. All values are finite, and within `range` from `low` on.
[[gnu::cold]] inline std::vector<double> weights_by_part(Values values, double low, double range) {
  constexpr std::size_t parts = 300;
  const auto part_of = [&](double value) {
    return std::min(parts - 1, static_cast<std::size_t>((value - low) / range * parts));
  };
  std::vector<double> seen(parts), weights;
  for (const double value : values) seen[part_of(value)] += 1;
  for (const double value : values) weights.push_back(1 / seen[part_of(value)]);
  return weights;
}

/// The step with which the errors (readings minus simulated) swing most over the simulated values: the largest peak of
/// their periodogram, the first wave of a sawtooth of any phase, since the simulation may be off by part of a step as
/// long as the model is fitted without it; all parts of the range counted alike. Empty: independent errors would give
/// as high a peak in one of twenty logs. Steps from the size of the errors to a quarter of the range are tried. Cost:
/// 3,000 samples times up to 10,000 steps. N. R. Lomb: "Least-squares frequency analysis of unequally spaced data",
/// Astrophysics and Space Science 39, 1976.
[[gnu::cold]] inline std::vector<double> sawtooth_steps(Values readings, Values simulated) {
  const std::size_t every = std::max<std::size_t>(1, readings.size() / 3000);
  std::vector<double> values, errors;
  double largest = 0;
  for (std::size_t i = 0; i < readings.size(); i += every) {
    if (!std::isfinite(simulated[i]) || !std::isfinite(readings[i])) continue;
    values.push_back(simulated[i]);
    errors.push_back(readings[i] - simulated[i]);
    largest = std::max(largest, std::abs(simulated[i]));
  }
  if (values.size() < 100) return {};
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const double low = *lowest, range = *highest - low;
  if (!(range > 0)) return {};
  const std::vector<double> weights = weights_by_part(values, low, range);
  double count = 0, weight_squares = 0, mean = 0, squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    count += weights[i];
    weight_squares += weights[i] * weights[i];
    mean += weights[i] * errors[i];
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    errors[i] -= mean / count;
    squares += weights[i] * errors[i] * errors[i];
  }
  const double size = std::sqrt(squares / count);
  if (!(size > 0)) return {};
  const auto taken_away = [&](double sum) { return 2 * sum * sum / (count * squares); };
  const double from = 4 / range, to = std::min(1 / size, 1000 / largest), apart = 0.1 / largest;
  constexpr double chance = 0.05;  // of any peak as high, of independent errors
  const double as_many = count * count / weight_squares, peaks = std::max(1.0, (to - from) * range);
  TurningWaves waves;  // of all errors
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double at = 2 * std::numbers::pi * values[i];
    waves.add(weights[i] * errors[i], at * from, at * apart);
  }
  double best = 0, share = 2 * std::log(peaks / chance) / as_many;
  for (double frequency = from; frequency < to; frequency += apart) {
    const double away = taken_away(waves.next_sum());
    if (away <= share) continue;
    share = away;
    best = frequency;
  }
  if (best == 0) return {};
  for (double width = apart; width > 1e-4 * apart; width *= 0.5) {  // uphill to the top of the peak
    for (const double next : {best - width, best + width}) {
      double cosine = 0, sine = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double phase = 2 * std::numbers::pi * values[i] * next;
        cosine += weights[i] * errors[i] * std::cos(phase);
        sine += weights[i] * errors[i] * std::sin(phase);
      }
      const double away = taken_away(std::hypot(cosine, sine));
      if (away <= share) continue;
      share = away;
      best = next;
    }
  }
  return {1 / best};
}

/// Both, crowding first.
[[gnu::cold]] inline std::vector<double> sensor_steps(Values readings, Values simulated) {
  std::vector<double> steps = lattice_steps(readings);
  for (const double step : sawtooth_steps(readings, simulated)) steps.push_back(step);
  return steps;
}

}  // namespace surefoot::effects
