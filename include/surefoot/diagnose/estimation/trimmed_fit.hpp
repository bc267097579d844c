// A fit that begins with the recordings that agree best. One recording in a valley of its own, as of a pendulum that
// goes over the top once too often, bends the parameters of all, and with them it stays there; without it they come
// right, and lead it out (least trimmed squares: P. J. Rousseeuw and K. van Driessen, "Computing LTS regression for
// large data sets", Data Mining and Knowledge Discovery 12, 2006).
#pragma once

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// `best`, or a clearly better fit that is reached from one to the half of the recordings that `best` fits best: with
/// the initial states of the others estimated from there, or, where that does not do, with the others from their first
/// rows on. As it is for fewer than three recordings. Costs two fits, or up to seven.
Fit trimmed_fit(const BoundSimulator& bound, Fit best, FitProblem problem, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/trimmed_fit.ipp"
#endif
