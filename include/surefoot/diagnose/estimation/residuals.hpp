// Residuals of a hypothesis: simulated minus measured, weighted by what an output may be off.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/pose2.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// How residuals are weighted: divided by sigma, by output, and by the scale of their recording; or, where noise
/// accumulates until a late measurement, multiplied by a matrix for each recording (the inverse of a square root of
/// their covariance).
struct Weighting {
  Eigen::VectorXd sigma;
  std::vector<double> scale = {};               // by recording of the bound, or empty: 1
  std::vector<Eigen::MatrixXd> whitening = {};  // by recording of the bound, or empty
  double robust = 4;                            // residuals beyond this count less (Huber)
};

/// Where residuals of one recording come from, in their order.
struct Cell {
  Eigen::Index row = 0, output = 0;
};

/// Whether the initial state is to be estimated.
inline bool has_unknown_initial_state(const Recording& recording) {
  for (const double scale : recording.initial_scale) {
    if (scale > 0) return true;
  }
  return false;
}

/// The measured cells of a recording that can be off: not the first row if the start is known from it.
std::vector<Cell> cells_of(const Recording& recording);

/// Simulated minus measured, in units of the outputs; infinite if the simulation ran away.
Eigen::VectorXd raw_residuals(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                              const std::vector<Cell>& cells);

/// Dimensionless residuals of one recording.
Eigen::VectorXd weighted_residuals(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                                   const std::vector<Cell>& cells, const Weighting& weighting);

/// Root mean square of the raw residuals by output over some recordings. Far outliers are left out, at most one in a
/// hundred: what is far off more often than that is not an accident.
Eigen::VectorXd residual_sizes(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                               const std::vector<SimulatedRun>& trajectories);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/residuals.ipp"
#endif
