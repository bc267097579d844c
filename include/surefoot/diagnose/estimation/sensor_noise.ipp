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

SUREFOOT_ONCE double fast_noise(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                Eigen::Index output) {
  std::vector<double> third;
  for (const std::size_t r : recordings) {
    const Eigen::VectorXd y = surefoot::detail::row_of(bound.recordings[r].outputs, output);
    for (Eigen::Index i = 0; i + 3 < y.size(); ++i) {
      const double d = y[i + 3] - 3 * y[i + 2] + 3 * y[i + 1] - y[i];
      if (std::isfinite(d)) third.push_back(std::abs(d));
    }
  }
  if (third.size() < 20) return 0;
  const auto middle = third.begin() + static_cast<std::ptrdiff_t>(third.size() / 2);
  std::nth_element(third.begin(), middle, third.end());
  return *middle / 0.6745 / std::sqrt(20.0);
}

SUREFOOT_ONCE double resolution(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                Eigen::Index output) {
  constexpr double rounding = 1e-9;  // of a reading: no step of a sensor
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t r : recordings) {
    const Eigen::VectorXd y = surefoot::detail::row_of(bound.recordings[r].outputs, output);
    for (Eigen::Index i = 1; i < y.size(); ++i) {
      const double step = std::abs(y[i] - y[i - 1]);
      if (step > rounding * std::abs(y[i])) least = std::min(least, step);
    }
  }
  return std::isfinite(least) ? least : 0;
}

SUREFOOT_ONCE double rounding_error(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                    Eigen::Index output) {
  constexpr double often = 0.2;  // of the rows: where less repeats, rounding looks like fast noise
  double repeated = 0, rows = 0;
  for (const std::size_t r : recordings) {
    const Eigen::MatrixXd& outputs = bound.recordings[r].outputs;
    for (Eigen::Index i = 1; i < outputs.cols(); ++i) repeated += outputs(output, i) == outputs(output, i - 1) ? 1 : 0;
    rows += static_cast<double>(outputs.cols());
  }
  if (!(repeated > often * rows)) return 0;
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
