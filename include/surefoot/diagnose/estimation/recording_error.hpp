// Errors of whole recordings, in units that people can compare: those of the noise, or of the spread of an output.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "surefoot/diagnose/estimation/calibrate.hpp"

namespace surefoot::diagnosis {

/// Root mean square error of one recording over its outputs, each in units of its scale.
double recording_error(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                       const Eigen::VectorXd& scale);

double over_all(const std::vector<double>& errors, const std::vector<double>& counts);

std::vector<double> cell_counts(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

/// The unit of errors, by output: its stated noise or, where none is stated, its spread over the recordings.
Eigen::VectorXd error_scale(const BoundSimulator& bound);

/// Error of a hypothesis on some recordings, each simulated as a whole.
double whole_error(const BoundSimulator& bound, const Hypothesis& hypothesis,
                   const std::vector<std::size_t>& recordings, Integration integration, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/recording_error.ipp"
#endif
