// A test whether residuals can be predicted, on recordings not used, from what the machine did at the time: a forest is
// trained on all folds but one. Sees what depends on place, heading or commands even where residuals have no memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"

namespace surefoot::diagnosis {

/// What a forest leaves, by fold, of residuals in units of sigma that it predicts from features after it has learned
/// from the other folds. Fewer than 50 samples teach it nothing.
std::vector<Eigen::MatrixXd> left_unpredicted(const std::vector<FeatureTable>& tables,
                                              const std::vector<Eigen::MatrixXd>& residuals, const Parallel& parallel,
                                              std::uint64_t seed);

/// For the output that a prediction helps most; the p-value pays for the choice. Cut off at `limit`.
Comparison most_predicted(const std::vector<Eigen::MatrixXd>& residuals, const std::vector<Eigen::MatrixXd>& left,
                          double limit);

/// The gain of such a prediction over none, for the output that shows it best: from all features, and from the states
/// alone, which finds small places better. The p-value pays for both choices.
Comparison residual_predictability(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                                   const std::vector<std::vector<std::size_t>>& folds, const Parallel& parallel,
                                   std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/predictability.ipp"
#endif
