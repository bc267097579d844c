// Definitions of surefoot/diagnose/estimation/recording_error.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double recording_error(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                                     const Eigen::VectorXd& scale) {
  const std::vector<Cell> cells = cells_of(bound.recordings[r]);
  Eigen::VectorXd off = raw_residuals(bound, r, trajectory, cells);
  for (std::size_t i = 0; i < cells.size(); ++i) off[static_cast<Eigen::Index>(i)] /= scale[cells[i].output];
  return off.size() > 0 ? std::sqrt(surefoot::detail::sum_of_squares(off) / static_cast<double>(off.size())) : 0;
}

SUREFOOT_ONCE double over_all(const std::vector<double>& errors, const std::vector<double>& counts) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += errors[i] * errors[i] * counts[i];
    count += counts[i];
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

SUREFOOT_ONCE std::vector<double> cell_counts(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  std::vector<double> counts;
  for (const std::size_t r : recordings) counts.push_back(static_cast<double>(cells_of(bound.recordings[r]).size()));
  return counts;
}

SUREFOOT_ONCE Eigen::VectorXd error_scale(const BoundSimulator& bound) {
  Eigen::VectorXd scale = output_deviations(bound, all_recordings(bound));
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    const double noise = bound.info.outputs[static_cast<std::size_t>(k)].noise;
    if (noise > 0) scale[k] = noise;
  }
  return scale;
}

SUREFOOT_ONCE std::vector<double> recording_errors(const BoundSimulator& bound,
                                                   const std::vector<std::size_t>& recordings,
                                                   const std::vector<SimulatedRun>& runs,
                                                   const Eigen::VectorXd& scale) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    errors.push_back(recording_error(bound, recordings[i], runs[i], scale));
  }
  return errors;
}

SUREFOOT_ONCE double error_over_all(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                    const std::vector<SimulatedRun>& runs) {
  return over_all(recording_errors(bound, recordings, runs, error_scale(bound)), cell_counts(bound, recordings));
}

SUREFOOT_ONCE std::vector<std::size_t> some_by_error(const BoundSimulator& bound,
                                                     const std::vector<std::size_t>& recordings,
                                                     const std::vector<SimulatedRun>& runs, std::size_t count) {
  if (recordings.size() <= count) return recordings;
  const std::vector<double> errors = recording_errors(bound, recordings, runs, error_scale(bound));
  std::vector<std::size_t> order(recordings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  sort_items(order, [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t rank = count > 1 ? i * (order.size() - 1) / (count - 1) : 0;
    result.push_back(recordings[order[rank]]);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace surefoot::diagnosis
