// Calibration of the nominal parameters and the unknown initial states: a wrong parameter is not missing physics.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"

namespace surefoot::diagnosis {

/// The same hypothesis from other parameters of the simulator: Latin-hypercube points over their bounds.
std::vector<Hypothesis> scattered(const BoundSimulator& bound, const Hypothesis& around, std::size_t points,
                                  std::uint64_t seed);

/// `best`, or a clearly better fit from one of the best such points around a hypothesis.
Fit scattered_fit(const BoundSimulator& bound, Fit best, const Hypothesis& around, const FitProblem& problem,
                  std::size_t points, std::uint64_t seed, const Parallel& parallel);

/// By recording: square root of the root mean square residual in units of sigma. Recordings that a model misses by far
/// then count more than others, but do not silence them.
std::vector<double> recording_scales(const BoundSimulator& bound, const FitProblem& problem,
                                     const std::vector<SimulatedRun>& trajectories);

/// Global start: from the nominal parameters, at once and with a growing horizon, and from Latin-hypercube points over
/// the bounds, of which the best few are fitted; the best of all is kept. Then twice more with each output and each
/// recording weighted by what is left of it.
Fit calibrate(const BoundSimulator& bound, const Hypothesis& nominal, FitProblem& problem, std::size_t points,
              std::uint64_t seed, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/calibrate.ipp"
#endif
