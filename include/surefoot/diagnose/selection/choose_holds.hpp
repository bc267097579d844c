// Inputs between rows: held, as commands of a digital controller are, or interpolated, as what was measured of
// something smooth is. Held instead of interpolated it comes half a row too late, which no delay can mend.
#pragma once

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Interpolates inputs of which the model does not say, or holds them again, where the fit `fitted` of an ODE predicts
/// recordings better with it, at the odds that name an effect; in `problem.fit.integration`, input by input. True if
/// anything changed: `fitted` is then the fit with it. Cost: a simulation for each such input, and a fit if that
/// matters against the residuals.
bool choose_holds(const BoundSimulator& bound, Fit& fitted, SearchProblem& problem, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/choose_holds.ipp"
#endif
