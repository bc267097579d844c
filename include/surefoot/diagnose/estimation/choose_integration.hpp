// Choice of the integration: as coarse as the errors of the model allow.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// The cheapest integration whose error over all of these recordings is small (5 %) against the residuals of each
/// output (`residual_size`, in its unit). Cost: at most 60 evaluations a row, in a
/// model that runs with one step.
Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                               const Eigen::VectorXd& residual_size, const Integration& now,
                               const std::vector<std::size_t>& recordings, const Parallel& parallel);

/// An integration for fits, and one as coarse as those may be that are only compared.
struct ChosenIntegration {
  Integration fitting, screening;
};

/// The same with the cheapest integration whose error is a quarter of the residuals: what screening compares differs by
/// more. No coarser than `fitting` where that is the cheapest.
ChosenIntegration choose_integrations(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                      const Eigen::VectorXd& residual_size, const Integration& now,
                                      const std::vector<std::size_t>& recordings, const Parallel& parallel);

/// Whether an integration is finer than another one.
bool is_finer(const Integration& one, const Integration& other);

/// The coarsest step at which as many of the recordings as possible can be simulated at all, without growing far beyond
/// what they do in half of it: one row, or a power of two shorter, where the model holds something much faster than
/// rows, such as the current of a coil. As it is now where none helps, and in maps. Cost: mostly two simulations of
/// each recording, a row and half a row at a step.
Integration integration_that_runs(const BoundSimulator& bound, const Hypothesis& hypothesis, const Parallel& parallel);

/// The same where it is finer than now: what effects explain leaves smaller residuals. None where it is not.
std::optional<Integration> finer_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const Eigen::VectorXd& residual_size, const Integration& now,
                                             const std::vector<std::size_t>& recordings, const Parallel& parallel);

/// The median interval [s] of the recording that has the shortest.
double shortest_interval(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

/// Share of the residuals that the way of simulating may add: lost in them.
inline constexpr double lost_in_residuals = 0.05;

/// The same of fits that are only compared, of which the best are continued with less: 0.06 of the mean square.
inline constexpr double lost_in_screening = 0.25;

/// Root mean square of the differences between runs of the same recordings, by output; infinite where one ran away.
/// Recordings that cannot be simulated exactly either count for nothing.
Eigen::VectorXd differences_of_runs(const std::vector<SimulatedRun>& runs, const std::vector<SimulatedRun>& exact,
                                    Eigen::Index outputs);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/choose_integration.ipp"
#endif
