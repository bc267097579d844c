// Errors of whole recordings, in units that people can compare: those of the noise, or of the spread of an output.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "surefoot/diagnose/calibrate.hpp"

namespace surefoot::detail {

/// Root mean square error of one recording over its outputs, each in units of its scale.
inline double recording_error(const Rig& rig, std::size_t r, const SimulatedRun& trajectory,
                              const Eigen::VectorXd& scale) {
  const std::vector<Cell> cells = cells_of(rig.recordings[r]);
  Eigen::VectorXd off = raw_residuals(rig, r, trajectory, cells);
  for (std::size_t i = 0; i < cells.size(); ++i) off[static_cast<Eigen::Index>(i)] /= scale[cells[i].output];
  return off.size() > 0 ? std::sqrt(off.squaredNorm() / static_cast<double>(off.size())) : 0;
}

inline double over_all(const std::vector<double>& errors, const std::vector<double>& counts) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += errors[i] * errors[i] * counts[i];
    count += counts[i];
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

inline std::vector<double> cell_counts(const Rig& rig, const std::vector<std::size_t>& recordings) {
  std::vector<double> counts;
  for (const std::size_t r : recordings) counts.push_back(static_cast<double>(cells_of(rig.recordings[r]).size()));
  return counts;
}

/// The unit of errors, by output: its stated noise or, where none is stated, its spread over the recordings.
inline Eigen::VectorXd error_scale(const Rig& rig) {
  std::vector<std::size_t> all(rig.recordings.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Eigen::VectorXd scale = output_spreads(rig, all);
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    const double noise = rig.info.outputs[static_cast<std::size_t>(k)].noise;
    if (noise > 0) scale[k] = noise;
  }
  return scale;
}

/// Error of a hypothesis on some recordings, each simulated as a whole.
inline double whole_error(const Rig& rig, const Hypothesis& hypothesis, const std::vector<std::size_t>& recordings,
                          Integration integration, const Parallel& parallel) {
  integration.restart = 0;
  const auto runs = simulate_all(rig, hypothesis, recordings, integration, parallel);
  const Eigen::VectorXd scale = error_scale(rig);
  std::vector<double> errors;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    errors.push_back(recording_error(rig, recordings[i], runs[i], scale));
  }
  return over_all(errors, cell_counts(rig, recordings));
}

}  // namespace surefoot::detail
