// The course of a change that sets in midway: the logistic curve, from 0 in the first row to 1 long after its middle.
// It holds those that grow ever faster, where the middle is not reached, and those that settle, where it is at once.
#pragma once

#include <cmath>
#include <vector>

#include "surefoot/diagnose/effects/detail/constants.hpp"

namespace surefoot::effects {

/// Share of the change that has come at time t from the first row on; half of it at `middle`, most of it within
/// `width` to either side.
inline double midway(double t, double middle, double width) {
  const auto curve = [&](double at) { return 1 / (1 + std::exp((middle - at) / width)); };
  return (curve(t) - curve(0)) / (1 - curve(0));
}

/// Parameters of such a change, which is at least `low` and at most `high`, and begins with a try of `start` to either
/// side.
[[gnu::cold]] inline std::vector<EffectParameter> midway_parameters(Measure change, double low, double high,
                                                                    double start) {
  return parameters_of(
      {{.name = "change", .measure = change, .low = low, .high = high, .starts = {-start, start}, .strength = true},
       {.name = "middle", .measure = {.time = 1}, .low = 0.1, .high = 50, .starts = {0.5, 2, 5}},
       {.name = "width", .measure = {.time = 1}, .low = 0.005, .high = 20, .starts = {0.1, 0.5}}});
}

}  // namespace surefoot::effects
