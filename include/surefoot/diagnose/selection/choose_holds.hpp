// Inputs between rows: held, as commands of a digital controller are, interpolated, as what was measured of something
// smooth is, or held before their row, as commands are that are logged after they acted. Held, the latter two come half
// a row or a row too late, which no delay can mend. Straight lines weaken what changes within a few rows, which a
// smooth curve does not: R. Pintelon, J. Schoukens, "System Identification: A Frequency Domain Approach", 2nd ed.,
// 2012, chapter 13, on what zero-order hold and band-limited assumptions mean.
#pragma once

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Chooses how inputs of which the model does not say go between rows, where the fit `fitted` of an ODE predicts
/// recordings better with another way, at the odds that name an effect; in `problem.fit.integration`, input by input.
/// Only what moves in most rows is interpolated, and with a smooth curve if straight lines were better than steps, or
/// are what the model says. True if anything changed: `fitted` is then the fit with it. Cost: two simulations for each
/// such input, and two fits if that matters against the residuals.
bool choose_holds(const BoundSimulator& bound, Fit& fitted, SearchProblem& problem, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/choose_holds.ipp"
#endif
