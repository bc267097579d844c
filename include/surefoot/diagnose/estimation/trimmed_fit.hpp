// A fit that begins with the recordings that agree best. One recording in a valley of its own, as of a pendulum that
// goes over the top once too often, bends the parameters of all, and with them it stays there; without it they come
// right, and lead it out (least trimmed squares: P. J. Rousseeuw and K. van Driessen, "Computing LTS regression for
// large data sets", Data Mining and Knowledge Discovery 12, 2006).
#pragma once

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// `best`, or a clearly better fit that begins where a fit to half of the recordings ends, those that `best` fits best.
/// The others join it with initial states estimated there; if that is not clearly better, with a growing horizon.
/// `best` for fewer than three recordings. Costs two fits, or up to seven.
Fit trimmed_fit(const BoundSimulator& bound, Fit best, FitProblem problem, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/trimmed_fit.ipp"
#endif
