// Calibrates the nominal parameters and the unknown initial states: a wrong parameter is not missing physics.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// Standard deviation of each output over some recordings.
Eigen::VectorXd output_spreads(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

/// The same hypothesis from other parameters of the simulator: Latin-hypercube points over their bounds.
std::vector<Hypothesis> scattered(const BoundSimulator& bound, const Hypothesis& around, std::size_t points,
                                  std::uint64_t seed);

/// `best`, or a clearly better fit from one of the two best such points around a hypothesis.
Fit scattered_fit(const BoundSimulator& bound, Fit best, const Hypothesis& around, const FitProblem& problem,
                  std::size_t points, std::uint64_t seed, const Parallel& parallel);

/// By recording: square root of the root mean square residual in units of sigma. Recordings that a model misses by far
/// then count more than others, but do not silence them.
std::vector<double> recording_scales(const BoundSimulator& bound, const FitProblem& problem,
                                     const std::vector<SimulatedRun>& trajectories);

/// Global start: Latin-hypercube points over the bounds beside the nominal one; the best few are fitted, the best of
/// those kept. Then twice more with each output and each recording weighed by what is left of it.
Fit calibrate(const BoundSimulator& bound, const Hypothesis& nominal, FitProblem& problem, std::size_t points,
              std::uint64_t seed, const Parallel& parallel);

/// The cheapest integration whose error is small against what is left of each output (5 %), tried on one recording.
Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis, const Eigen::VectorXd& left,
                               const Integration& now, std::size_t recording);

/// Rates from each row to the next [1/s, or per step]; none for less than two rows.
Eigen::MatrixXd row_rates(const Eigen::VectorXd& time, const Eigen::MatrixXd& states);

/// Typical sizes of everything along the trajectories of a hypothesis.
Sizes measure_sizes(const BoundSimulator& bound, const Hypothesis& hypothesis,
                    const std::vector<std::size_t>& recordings, const std::vector<SimulatedRun>& trajectories);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/calibrate.ipp"
#endif
