// A fit under the guidance of the readings: first of a simulation that is drawn towards them, then less and less. What
// is predicted then reaches only as far ahead as the guidance lets it, and the error over so short a horizon has few
// valleys, wherever in a recording that is (H. D. I. Abarbanel et al., "Dynamical state and parameter estimation", SIAM
// J. Appl. Dyn. Syst. 8, 2009; C. P. Vyasarayani et al., "Single-shooting homotopy method for parameter identification
// in dynamical systems", Phys. Rev. E 85, 2012).
#pragma once

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// `best`, or a clearly better fit that is reached from `start` on under guidance; `best` at once where no state is
/// measured. Costs about four fits.
Fit guided_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
               const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/guided_fit.ipp"
#endif
