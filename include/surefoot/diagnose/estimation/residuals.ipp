// Definitions of surefoot/diagnose/estimation/residuals.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/estimation/residuals.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE std::vector<Cell> cells_of(const Recording& recording) {
  const bool known_start = !has_unknown_initial_state(recording);
  std::vector<Cell> cells;
  for (Eigen::Index row = known_start ? 1 : 0; row < recording.rows(); ++row) {
    for (Eigen::Index k = 0; k < recording.outputs.rows(); ++k) {
      if (std::isfinite(recording.outputs(k, row))) cells.push_back({row, k});
    }
  }
  return cells;
}

SUREFOOT_INLINE Eigen::VectorXd raw_residuals(const BoundSimulator& bound, std::size_t r,
                                              const SimulatedRun& trajectory, const std::vector<Cell>& cells) {
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(cells.size()));
  if (!trajectory.finite) {
    residuals.setConstant(std::numeric_limits<double>::infinity());
    return residuals;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    double off = trajectory.outputs(cell.output, cell.row) - bound.recordings[r].outputs(cell.output, cell.row);
    if (bound.wrapped[static_cast<std::size_t>(cell.output)]) off = wrap_angle(off);
    residuals[static_cast<Eigen::Index>(i)] = off;
  }
  return residuals;
}

SUREFOOT_INLINE Eigen::VectorXd weighted_residuals(const BoundSimulator& bound, std::size_t r,
                                                   const SimulatedRun& trajectory, const std::vector<Cell>& cells,
                                                   const Weighting& weighting) {
  Eigen::VectorXd residuals = raw_residuals(bound, r, trajectory, cells);
  if (!weighting.whitening.empty() && weighting.whitening[r].rows() == residuals.size()) {
    return surefoot::detail::product(weighting.whitening[r], residuals);
  }
  const double scale = weighting.scale.empty() ? 1 : weighting.scale[r];
  for (std::size_t i = 0; i < cells.size(); ++i) {
    residuals[static_cast<Eigen::Index>(i)] /= scale * weighting.sigma[cells[i].output];
  }
  return residuals;
}

SUREFOOT_ONCE Eigen::VectorXd residual_sizes(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                             const std::vector<SimulatedRun>& trajectories) {
  constexpr double outlier = 6;               // times the size so far
  constexpr std::size_t common_percent = 99;  // of the residuals that are never left out
  constexpr double smallest = 1e-12;          // in place of 0, so that a size may be divided by
  std::vector<std::vector<double>> by_output(bound.info.outputs.size());
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::vector<Cell> cells = cells_of(bound.recordings[recordings[i]]);
    const Eigen::VectorXd off = raw_residuals(bound, recordings[i], trajectories[i], cells);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      by_output[static_cast<std::size_t>(cells[k].output)].push_back(off[static_cast<Eigen::Index>(k)]);
    }
  }
  Eigen::VectorXd sizes(static_cast<Eigen::Index>(by_output.size()));
  for (std::size_t k = 0; k < by_output.size(); ++k) {
    std::vector<double> absolute;
    for (const double value : by_output[k]) absolute.push_back(std::abs(value));
    const auto rare = absolute.begin() + static_cast<std::ptrdiff_t>(absolute.size() * common_percent / 100);
    if (rare != absolute.end()) std::nth_element(absolute.begin(), rare, absolute.end());
    const double common = rare != absolute.end() ? *rare : 0;
    double size = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 3; ++round) {
      double sum = 0, count = 0;
      for (const double value : by_output[k]) {
        if (std::abs(value) > std::max(outlier * size, common)) continue;
        sum += value * value;
        ++count;
      }
      size = count > 0 ? std::sqrt(sum / count) : 0;
    }
    sizes[static_cast<Eigen::Index>(k)] = size > 0 ? size : smallest;
  }
  return sizes;
}

}  // namespace surefoot::diagnosis
