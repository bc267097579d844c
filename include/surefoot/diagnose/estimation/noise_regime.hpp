// Kinds of noise: a walk that is off by a little in every step is off by more at the end. They decide how simulations
// are compared with recordings; final poses are weighted by the covariance that such noise leaves in them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

enum class NoiseKind : unsigned char {
  measurement,  // whole recordings are simulated
  process,      // predicted row by row, each from the measured state before
  final_pose,   // accumulates until the only measurement, in the last row
};

/// Rows over which such noise may be correlated.
inline Eigen::Index memory_of(NoiseKind noise) { return noise == NoiseKind::process ? 3 : 8; }

/// Correlations between errors of predictions from one measured row to the next that are one, two and three rows apart,
/// about their mean (columns), by output (rows): -1/2, 0, 0 for measurement noise, 0 for noise of the process.
Eigen::MatrixXd step_correlations(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                  const std::vector<std::size_t>& recordings);

bool only_final_pose(const BoundSimulator& bound);

/// Whether recordings have so few readings, fewer than 20 in the median, that they say nothing of what happens between
/// rows nor of hidden states at their beginning: what each recording may choose for itself would fit its readings.
bool few_readings(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

NoiseKind noise_kind(const BoundSimulator& bound, const Hypothesis& hypothesis,
                     const std::vector<std::size_t>& recordings);

/// Matrices that make final poses' residuals white: noise of each step (position, heading), carried to the end along
/// the simulated path, and noise of the tape; their four variances by maximum likelihood on the residuals.
std::vector<Eigen::MatrixXd> final_pose_whitening(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                  const std::vector<std::size_t>& recordings,
                                                  const Integration& integration);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/noise_regime.ipp"
#endif
