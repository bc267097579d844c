// Definitions of surefoot/diagnose/estimation/typical_sizes.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Eigen::VectorXd output_deviations(const BoundSimulator& bound,
                                                const std::vector<std::size_t>& recordings) {
  constexpr double rounding = 1e-12;  // of the mean: a deviation below it is none
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(bound.info.outputs.size()));
  for (Eigen::Index k = 0; k < deviations.size(); ++k) {
    double sum = 0, squares = 0, count = 0;
    for (const std::size_t r : recordings) {
      for (const double value : surefoot::detail::row_of(bound.recordings[r].outputs, k)) {
        if (!std::isfinite(value)) continue;
        sum += value;
        squares += value * value;
        ++count;
      }
    }
    const double mean = count > 0 ? sum / count : 0;
    const double deviation = count > 0 ? std::sqrt(std::max(0.0, squares / count - mean * mean)) : 0;
    deviations[k] = deviation > rounding * (1 + std::abs(mean)) ? deviation : 1;
  }
  return deviations;
}

SUREFOOT_ONCE Eigen::MatrixXd row_rates(const Eigen::VectorXd& time, const Eigen::MatrixXd& states) {
  const Eigen::Index intervals = std::max<Eigen::Index>(0, states.cols() - 1);
  Eigen::MatrixXd rates(states.rows(), intervals);
  for (Eigen::Index j = 0; j < intervals; ++j) {
    const double per_second = 1 / (time[j + 1] - time[j]);
    for (Eigen::Index i = 0; i < states.rows(); ++i) rates(i, j) = (states(i, j + 1) - states(i, j)) * per_second;
  }
  return rates;
}

/// Lowers the least absolute value other than 0 of each row.
SUREFOOT_ONCE void lower_least(double* least, const Eigen::MatrixXd& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    double& one = least[i % values.rows()];
    const double size = std::abs(values.data()[i]);
    if (size > 0 && size < one) one = size;
  }
}

/// Raises each peak to the largest absolute value of its row.
SUREFOOT_ONCE void raise_peaks(std::vector<double>& peaks, const Eigen::MatrixXd& values) {
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    for (const double value : surefoot::detail::row_of(values, static_cast<Eigen::Index>(k))) {
      if (std::isfinite(value)) peaks[k] = std::max(peaks[k], std::abs(value));
    }
  }
}

/// Widens ranges to the values of each row.
SUREFOOT_ONCE void widen(std::vector<double>& low, std::vector<double>& high, const Eigen::MatrixXd& values) {
  for (std::size_t k = 0; k < low.size(); ++k) {
    for (const double value : surefoot::detail::row_of(values, static_cast<Eigen::Index>(k))) {
      if (!std::isfinite(value)) continue;
      low[k] = std::min(low[k], value);
      high[k] = std::max(high[k], value);
    }
  }
}

/// Weighted sums of squares by row; about the mean of the row, or about zero.
SUREFOOT_ONCE void add_squares(std::vector<double>& sums, const Eigen::MatrixXd& values, double weight,
                               bool about_mean) {
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Eigen::VectorXd line = surefoot::detail::row_of(values, static_cast<Eigen::Index>(k));
    const double size = about_mean ? standard_deviation(line) : root_mean_square(line);
    sums[k] += weight * size * size;
  }
}

/// Roots of mean squares; 1 for what is always 0.
SUREFOOT_ONCE void set_sizes(std::vector<double>& sizes, const std::vector<double>& sums, double weight) {
  constexpr double nothing = 1e-9;  // in units of the model: below it, it does not move
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double size = weight > 0 ? std::sqrt(sums[k] / weight) : 1;
    sizes[k] = size > nothing ? size : 1;
  }
}

/// Squares of the forces along a trajectory, by state: of the whole, or of the largest part of it that goes where one of
/// the states stays at its mean. In a stiff machine large forces all but cancel, and the whole tells nothing of them.
SUREFOOT_ONCE std::vector<double> force_squares(const BoundSimulator& bound, std::size_t recording,
                                                const Eigen::VectorXd& parameters, const Eigen::MatrixXd& states,
                                                const Eigen::MatrixXd& efforts) {
  std::vector<double> largest(static_cast<std::size_t>(states.rows()));
  const bool map = bound.info.kind == SimulatorKind::map;
  add_squares(largest, efforts, 1, map);
  for (Eigen::Index j = 0; j < states.rows() && !map; ++j) {
    Eigen::MatrixXd held = states, rest, signals;
    double mean = 0;
    for (Eigen::Index row = 0; row < held.cols(); ++row) mean += held(j, row) / static_cast<double>(held.cols());
    for (Eigen::Index row = 0; row < held.cols(); ++row) held(j, row) = mean;
    bound.probe(bound, recording, parameters, held, rest, signals);
    for (Eigen::Index i = 0; i < rest.size(); ++i) rest.data()[i] = efforts.data()[i] - rest.data()[i];
    std::vector<double> part(largest.size());
    add_squares(part, rest, 1, false);
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (std::isfinite(part[i])) largest[i] = std::max(largest[i], part[i]);
    }
  }
  return largest;
}

SUREFOOT_ONCE Sizes measure_sizes(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                  const std::vector<std::size_t>& recordings,
                                  const std::vector<SimulatedRun>& trajectories) {
  constexpr double time_rows = 200;  // rows of a typical time: what effects do within it, and over it, can be seen
  Sizes sizes = bound.sizes;
  const auto n = bound.info.states.size(), m = bound.info.inputs.size(), s = bound.info.signals.size();
  std::vector<double> state(n), position(n), rate(n), effort(n), input(m), signal(s);
  sizes.state_peak.assign(n, 0.0);
  sizes.input_low.assign(m, 0.0);
  sizes.input_high.assign(m, 0.0);
  sizes.signal_peak.assign(s, 0.0);
  sizes.least.assign(m + s, std::numeric_limits<double>::infinity());
  double rows = 0, intervals = 0, duration = 0;
  for (const std::size_t r : recordings) {
    intervals += static_cast<double>(bound.recordings[r].rows() - 1);
    duration += bound.recordings[r].duration();
  }
  sizes.time = intervals > 0 && duration > 0 ? time_rows * duration / intervals : 1;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Recording& recording = bound.recordings[recordings[i]];
    const Eigen::MatrixXd& states = trajectories[i].states;
    if (!trajectories[i].finite) continue;
    Eigen::MatrixXd efforts, signals;
    bound.probe(bound, recordings[i], hypothesis.parameters, states, efforts, signals);
    const auto weight = static_cast<double>(recording.rows());
    rows += weight;
    add_squares(state, states, weight, false);
    add_squares(position, states, weight, true);
    add_squares(rate, row_rates(recording.time, states), weight, false);
    const std::vector<double> forces = force_squares(bound, recordings[i], hypothesis.parameters, states, efforts);
    for (std::size_t k = 0; k < n; ++k) effort[k] += weight * forces[k];
    add_squares(input, recording.inputs, weight, false);
    add_squares(signal, signals, weight, false);
    raise_peaks(sizes.state_peak, states);
    widen(sizes.input_low, sizes.input_high, recording.inputs);
    raise_peaks(sizes.signal_peak, signals);
    lower_least(sizes.least.data(), recording.inputs);
    lower_least(sizes.least.data() + m, signals);
  }
  set_sizes(sizes.state, state, rows);
  set_sizes(sizes.position, position, rows);
  set_sizes(sizes.rate, rate, rows);
  set_sizes(sizes.effort, effort, rows);
  set_sizes(sizes.input, input, rows);
  set_sizes(sizes.signal, signal, rows);
  const Eigen::VectorXd deviations = output_deviations(bound, recordings);
  for (Eigen::Index k = 0; k < deviations.size(); ++k) sizes.output[static_cast<std::size_t>(k)] = deviations[k];
  return sizes;
}

}  // namespace surefoot::diagnosis
