// A fit to the beginnings of the recordings first, then to twice as much of them, and so on. Over a short horizon the
// error has few valleys; over a long one, a pendulum with a wrong length is out of step, and the error has a valley for
// each swing that it may be ahead or behind (Bock, "Recent advances in parameter identification techniques for ODE",
// 1983, has multiple shooting for the same reason).
#pragma once

#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// The same simulator over the first `share` (0 to 1) of the rows of these recordings, two at least.
BoundSimulator beginnings(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, double share);

/// `best`, or a clearly better fit that is reached from `start` on with a growing horizon, that of these `recordings`.
/// The problem's prior, if it has one, holds on the way alone: first rows tell little of most parameters. Costs less
/// than two fits where all horizons grow, at most five.
Fit grown_fit_of(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
                 const std::vector<std::size_t>& recordings, const Parallel& parallel);

/// The same with all horizons growing.
Fit grown_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
              const Parallel& parallel);

/// A hypothesis with the unknown initial states of some recordings estimated, those of each with a growing horizon
/// where that fits it clearly better, and all else as it is.
Hypothesis with_grown_initial_states(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                     const std::vector<std::size_t>& recordings, FitProblem problem,
                                     const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/growing_horizon.ipp"
#endif
