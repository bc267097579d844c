// A fit under the guidance of the readings: first of a simulation that is drawn towards them, then less and less. What
// is predicted then reaches only as far ahead as the guidance lets it, and the error over so short a horizon has few
// valleys, wherever in a recording that is (H. D. I. Abarbanel et al., "Dynamical state and parameter estimation", SIAM
// J. Appl. Dyn. Syst. 8, 2009; C. P. Vyasarayani et al., "Single-shooting homotopy method for parameter identification
// in dynamical systems", Phys. Rev. E 85, 2012).
#pragma once

#include <array>
#include <span>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// Horizons of the guidance, from the shortest on, as shares of a recording.
inline constexpr std::array<double, 3> guided_horizons{1.0 / 64, 1.0 / 16, 1.0 / 4};

/// Whether simulations can follow readings: an output measures a state.
bool can_follow(const BoundSimulator& bound);

/// Whether fits can be guided: where each row starts from readings anyway there is nothing to follow.
bool can_be_guided(const BoundSimulator& bound, const FitProblem& problem);

/// Integration::follow that lets predictions reach as far as a share of a recording; no less than the problem has.
double guided_follow(const BoundSimulator& bound, const FitProblem& problem, double horizon);

/// What is reached from `start` on under guidance that lets predictions reach as far as these shares of a recording,
/// one after the other; `start` where no state is measured. Over a short horizon physics that is missing has little
/// time to push parameters away, so that these hardly depend on where they start.
Hypothesis guided(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
                  std::span<const double> horizons, const Parallel& parallel);

/// `best`, or a clearly better fit that is reached from `start` on under guidance; `best` at once where no state is
/// measured. The problem's prior, if it has one, holds on the way alone. Costs about four fits.
Fit guided_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
               const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/guided_fit.ipp"
#endif
