// A test whether a walk loses a share of its steps at some places: slippery or sticky floor. The error of a step is
// then its own size times a factor that depends on the place, so that it averages out over commands to all sides, and
// place alone predicts nothing. The factor is learned by a forest on all folds but one: as the ratio of the means of
// error times step and of step squared, for each direction of the body by itself.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"

namespace surefoot::diagnosis {

/// Steps of a walk of which the poses before and after were measured.
struct MeasuredSteps {
  Eigen::MatrixXd place;                // where the step began: x, y
  Eigen::MatrixXd simulated, residual;  // simulated displacement, and simulated minus measured, in the body's frame
};

/// Each step is simulated from the measured pose before it. Nothing if the simulator is not planar or an output does
/// not read x, y and heading each.
std::optional<MeasuredSteps> measured_steps(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                            const std::vector<SimulatedRun>& runs);

/// One-sided: how often a sum is as large if each of its terms may as well have the other sign.
double sign_flip_p_value(const std::vector<double>& terms);

/// Residuals of a fold's steps without what a forest, trained on the other folds, predicts of them from their place.
Eigen::MatrixXd left_by_slip(const std::vector<MeasuredSteps>& by_fold, std::size_t fold, std::uint64_t seed);

/// The gain for the direction of the body that shows it best.
Comparison best_direction(const std::vector<MeasuredSteps>& by_fold, const std::vector<Eigen::MatrixXd>& left);

/// The gain, on folds not used, of predicting the errors of steps by such a factor over no prediction, for the
/// direction that shows it best; the p-value, by random signs, pays for that choice. Few steps at one place are enough.
/// For walks with a pose in every row, simulated from each to the next.
Comparison slip_by_place(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                         const std::vector<std::vector<std::size_t>>& folds, const Parallel& parallel,
                         std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/walking/slip_by_place.ipp"
#endif
