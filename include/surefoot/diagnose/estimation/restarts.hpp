// Restarts of a fit from places around where it ended, against local minima near by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// The same hypothesis with parameters of the simulator and of its effects moved at random: by factors up to 2, those
/// that may be negative by up to half of their size. Deterministic in `seed`.
std::vector<Hypothesis> moved_around(const BoundSimulator& bound, const Hypothesis& fitted, std::size_t points,
                                     std::uint64_t seed);

/// A fit, or a clearly better one from one of `points` places around it. All are first compared by a few iterations on
/// the recordings of `quick`. Cost: points * (2 + iterations) Jacobians at most.
Fit restarted_fit(const BoundSimulator& bound, const Fit& fitted, const FitProblem& problem, const FitProblem& quick,
                  std::size_t points, std::uint64_t seed, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/restarts.ipp"
#endif
