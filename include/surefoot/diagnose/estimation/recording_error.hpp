// Errors of whole recordings, in units that people can compare: those of the noise, or of the standard deviation of an
// output.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "surefoot/diagnose/estimation/residuals.hpp"

namespace surefoot::diagnosis {

/// Root mean square error of one recording over its outputs, each in units of its scale.
double recording_error(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                       const Eigen::VectorXd& scale);

/// Root mean square of the errors of some recordings, each counted as often as it has cells.
double over_all(const std::vector<double>& errors, const std::vector<double>& counts);

/// How many cells each recording has.
std::vector<double> cell_counts(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

/// The unit of errors, by output: its stated noise or, where none is stated, its standard deviation over the
/// recordings.
Eigen::VectorXd error_scale(const BoundSimulator& bound);

/// Error of each recording; `runs` go with `recordings`.
std::vector<double> recording_errors(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                     const std::vector<SimulatedRun>& runs, const Eigen::VectorXd& scale);

/// Error over all of some recordings, in units of error_scale().
double error_over_all(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                      const std::vector<SimulatedRun>& runs);

/// At most `count` recordings, from the one that a model misses most to the one that it misses least, in even steps; in
/// whatever order they come.
std::vector<std::size_t> some_by_error(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                       const std::vector<SimulatedRun>& runs, std::size_t count);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/recording_error.ipp"
#endif
