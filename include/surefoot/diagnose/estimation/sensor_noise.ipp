// Definitions of surefoot/diagnose/estimation/sensor_noise.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Readings of one output, without rows that were not read.
struct Readings {
  std::vector<double> rows, values;
};

SUREFOOT_ONCE Readings readings_of(const Recording& recording, Eigen::Index output) {
  Readings read;
  for (Eigen::Index i = 0; i < recording.outputs.cols(); ++i) {
    if (!std::isfinite(recording.outputs(output, i))) continue;
    read.rows.push_back(static_cast<double>(i));
    read.values.push_back(recording.outputs(output, i));
  }
  return read;
}

/// Third divided difference of four readings in turn, by the root of the sum of its squared weights.
SUREFOOT_ONCE double third_difference(const Readings& read, std::size_t first) {
  double sum = 0, squares = 0;
  for (std::size_t i = first; i < first + 4; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < first + 4; ++j) {
      if (j != i) weight /= read.rows[i] - read.rows[j];
    }
    sum += weight * read.values[i];
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

SUREFOOT_ONCE double fast_noise(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                Eigen::Index output) {
  std::vector<double> third;
  for (const std::size_t r : recordings) {
    const Readings read = readings_of(bound.recordings[r], output);
    for (std::size_t i = 0; i + 3 < read.rows.size(); ++i) third.push_back(std::abs(third_difference(read, i)));
  }
  if (third.size() < 20) return 0;
  const auto middle = third.begin() + static_cast<std::ptrdiff_t>(third.size() / 2);
  std::nth_element(third.begin(), middle, third.end());
  return *middle / 0.6745;
}

SUREFOOT_ONCE double resolution(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                Eigen::Index output) {
  constexpr double rounding = 1e-9;  // of a reading: no step of a sensor
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t r : recordings) {
    const std::vector<double> y = readings_of(bound.recordings[r], output).values;
    for (std::size_t i = 1; i < y.size(); ++i) {
      const double step = std::abs(y[i] - y[i - 1]);
      if (step > rounding * std::abs(y[i])) least = std::min(least, step);
    }
  }
  return std::isfinite(least) ? least : 0;
}

SUREFOOT_ONCE double rounding_error(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                    Eigen::Index output) {
  constexpr double often = 0.2;  // of the readings: where less repeats, rounding looks like fast noise
  double repeated = 0, count = 0;
  for (const std::size_t r : recordings) {
    const std::vector<double> y = readings_of(bound.recordings[r], output).values;
    for (std::size_t i = 1; i < y.size(); ++i) repeated += y[i] == y[i - 1] ? 1 : 0;
    count += static_cast<double>(y.size());
  }
  if (!(repeated > often * count)) return 0;
  return resolution(bound, recordings, output) / std::sqrt(12.0);  // evenly spread over a step
}

SUREFOOT_ONCE void free_measured_initial_states(BoundSimulator& bound, const std::vector<std::size_t>& training) {
  constexpr double least_noise = 1e-6;  // of an output's standard deviation: a sensor without noise reads the state
  const Eigen::VectorXd deviations = output_deviations(bound, training);
  for (std::size_t i = 0; i < bound.info.states.size(); ++i) {
    const int output = bound.structure.output_of[i];
    if (output < 0) continue;
    const StateReading way = reading_of(bound.structure, i);
    const double noise = std::max(noise_of(bound, training, output), rounding_error(bound, training, output));
    const double deviation = deviations[output];
    for (Recording& recording : bound.recordings) {
      const auto state = static_cast<Eigen::Index>(i);
      if (recording.initial_scale[state] > 0) continue;
      if (recording.initial[state] != way.state_at(recording.outputs(output, 0))) continue;
      if (noise > least_noise * deviation) recording.initial_scale[state] = noise / std::abs(way.slope);
    }
  }
}

}  // namespace surefoot::diagnosis
