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

namespace surefoot::diagnosis {

/// Third divided difference of four readings in turn, by the root of the sum of its squared weights.
SUREFOOT_ONCE double third_difference(const double (&rows)[4], const double (&values)[4]) {
  double sum = 0, squares = 0;
  for (int i = 0; i < 4; ++i) {
    double weight = 1;
    for (int j = 0; j < 4; ++j) {
      if (j != i) weight /= rows[i] - rows[j];
    }
    sum += weight * values[i];
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

SUREFOOT_ONCE double fast_noise(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                Eigen::Index output) {
  std::vector<double> third;
  for (const std::size_t r : recordings) {
    const Eigen::MatrixXd& outputs = bound.recordings[r].outputs;
    double rows[4] = {}, values[4] = {};  // of the last readings
    int count = 0;
    for (Eigen::Index row = 0; row < outputs.cols(); ++row) {
      if (!std::isfinite(outputs(output, row))) continue;
      for (int i = 0; i < 3; ++i) {
        rows[i] = rows[i + 1];
        values[i] = values[i + 1];
      }
      rows[3] = static_cast<double>(row);
      values[3] = outputs(output, row);
      if (++count >= 4) third.push_back(std::abs(third_difference(rows, values)));
    }
  }
  if (third.size() < 20) return 0;
  const auto middle = third.begin() + static_cast<std::ptrdiff_t>(third.size() / 2);
  std::nth_element(third.begin(), middle, third.end());
  return *middle / 0.6745;
}

/// Steps between readings of one output in turn.
struct Steps {
  double count = 0, repeated = 0;  // readings, and those equal to the one before
  double least = 0;                // of those that differ; 0 if none does
};

SUREFOOT_ONCE Steps steps_of(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                             Eigen::Index output) {
  constexpr double rounding = 1e-9;  // of a reading: no step of a sensor
  Steps steps;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t r : recordings) {
    const Eigen::MatrixXd& outputs = bound.recordings[r].outputs;
    double before = std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index row = 0; row < outputs.cols(); ++row) {
      const double reading = outputs(output, row);
      if (!std::isfinite(reading)) continue;
      ++steps.count;
      const double step = std::abs(reading - before);  // not a number for the first
      if (step > rounding * std::abs(reading)) least = std::min(least, step);
      steps.repeated += reading == before ? 1 : 0;
      before = reading;
    }
  }
  if (std::isfinite(least)) steps.least = least;
  return steps;
}

SUREFOOT_ONCE double resolution(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                Eigen::Index output) {
  return steps_of(bound, recordings, output).least;
}

SUREFOOT_ONCE double rounding_error(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                    Eigen::Index output) {
  constexpr double often = 0.2;  // of the readings: where less repeats, rounding looks like fast noise
  const Steps steps = steps_of(bound, recordings, output);
  if (!(steps.repeated > often * steps.count)) return 0;
  return steps.least / std::sqrt(12.0);  // evenly spread over a step
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
