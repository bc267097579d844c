// Typical sizes of outputs, states, inputs and forces, in which effects are measured.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// Standard deviation of each output over some recordings; 1 for an output that does not change.
Eigen::VectorXd output_deviations(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

/// Rates from each row to the next [1/s, or per step]; none for less than two rows.
Eigen::MatrixXd row_rates(const Eigen::VectorXd& time, const Eigen::MatrixXd& states);

/// Typical sizes of everything along the trajectories of a hypothesis.
Sizes measure_sizes(const BoundSimulator& bound, const Hypothesis& hypothesis,
                    const std::vector<std::size_t>& recordings, const std::vector<SimulatedRun>& trajectories);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/typical_sizes.ipp"
#endif
