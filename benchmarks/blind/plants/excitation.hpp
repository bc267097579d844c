// Commands over time for the experiments.
#pragma once

#include <cmath>
#include <numbers>

#include "plant.hpp"

namespace plants {

inline double rounded(double value, double step) { return std::round(value / step) * step; }

/// Row times [s], uneven by up to a fifth of the period.
inline Column jittered_times(Random& random, double duration, double period, bool jitter) {
  Column times;
  for (double t = 0; t < duration; t += period) {
    const double shift = jitter && t > 0 ? random.uniform(-0.2, 0.2) * period : 0;
    times.push_back(rounded(t + shift, period * 1e-4));
  }
  return times;
}

enum class Shape { steps, multisine, ramps, chirp };

/// An order that starts at `middle` and moves by up to `amplitude` around it; `period` [s]: typical time of a change.
inline Column excite(Random& random, const Column& times, Shape shape, double middle, double amplitude, double period,
                     double resolution) {
  Column order;
  const double circle = 2 * std::numbers::pi;
  double level = 0, next_change = 0.2 * period;
  const double phases[3] = {random.uniform(0, circle), random.uniform(0, circle), random.uniform(0, circle)};
  const double direction = random.sign();
  for (double t : times) {
    double value = 0;
    switch (shape) {
      case Shape::steps:
        if (t >= next_change) {
          level = random.uniform(-1, 1);
          next_change = t + period * random.uniform(0.4, 1.2);
        }
        value = level;
        break;
      case Shape::multisine:
        for (int k = 0; k < 3; ++k) {
          const double rate = circle / period * (0.45 + 0.6 * k);
          value += 0.45 * (std::sin(rate * t + phases[k]) - std::sin(phases[k]));
        }
        break;
      case Shape::ramps:
        value = direction * std::asin(std::sin(circle * t / (3 * period))) * 2 / std::numbers::pi;
        break;
      case Shape::chirp:
        value = direction * std::sin(circle / period * (0.3 * t + 0.12 * t * t / period));
        break;
    }
    order.push_back(rounded(middle + amplitude * value, resolution));
  }
  return order;
}

}  // namespace plants
