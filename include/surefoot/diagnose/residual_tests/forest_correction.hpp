// A forest in place of physics: learns from features of the simulated motion what a simulator leaves of its outputs,
// and takes it off. Whole recordings are simulated, so that it needs nothing measured. It is the yardstick for effects,
// and what is offered where none explains a mismatch.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot::diagnosis {

/// Residuals of the table's samples, in units of sigma, cut off at `limit`; 0 where nothing was measured.
Eigen::MatrixXd residual_table(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                               const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                               const FeatureTable& table, double limit = 10);

/// Numbers beyond those of single precision are cut off.
inline float single_precision(double value) { return static_cast<float>(std::min(std::max(value, -1e30), 1e30)); }

/// The one place where a diagnosis trains a forest. The result does not depend on how `parallel` shares out the work.
ResidualForest train_forest(const Dataset<Eigen::Dynamic, Eigen::Dynamic>& samples, int min_leaf,
                            const Parallel& parallel, std::uint64_t seed);

/// Learns from at most about 8000 rows in which something was measured. `runs` are whole simulations.
ResidualModel train_residual_model(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                   const std::vector<SimulatedRun>& runs, const Parallel& parallel, std::uint64_t seed);

/// A simulated recording with what the model expects taken off its outputs. Throws DiagnoseError if the
/// model asks for a feature that the simulator and the recording do not have.
SimulatedRun corrected(const BoundSimulator& bound, std::size_t recording, const SimulatedRun& run,
                       const ResidualModel& model);

/// What the forest gains in simulations of recordings it has not seen: each fold is corrected by a model of the others.
/// `runs` go with `recordings`.
Comparison cross_validate_residual(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                   const std::vector<SimulatedRun>& runs,
                                   const std::vector<std::vector<std::size_t>>& folds, const Weighting& weighting,
                                   const Parallel& parallel, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/forest_correction.ipp"
#endif
