// Initial states that a model takes for known: recordings often begin in motion where a model says that all is at rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Frees initial states of an ODE that are said to be known (`initial_scale` 0) in all of its recordings and
/// that no sensor reads, one state after the other, where the fit `fitted` then predicts recordings better at the odds
/// that name an effect, beyond what as many free numbers would do by chance (BIC). By state: freed. `fitted` is then
/// the fit with them. Cost: by state a fit of initial states alone, and a whole one if that helps.
std::vector<bool> free_initial_states(BoundSimulator& bound, Fit& fitted, const SearchProblem& problem,
                                      const Parallel& parallel);

/// Initial states that are freed at once, and the fit from many places with them.
struct FreedTogether {
  std::vector<bool> states = {};
  Fit fitted = {};
  double log_odds = -std::numeric_limits<double>::infinity();  // against known ones
};

/// All states that `free_initial_states` may free, at once, and the model without effects calibrated with them: where a
/// wrong start has led the calibration astray, one state alone, from there on, mends nothing. Leaves the recordings as
/// they are. Cost: a calibration.
FreedTogether free_together(BoundSimulator bound, const Fit& known, const SearchProblem& problem, std::size_t starts,
                            std::uint64_t seed, const Parallel& parallel);

/// Takes states that were freed for known again unless `fitted` needs them free at the same odds: what else was found
/// may do what they did. `freed` holds what stays free.
void restore_initial_states(BoundSimulator& bound, std::vector<bool>& freed, Fit& fitted, const SearchProblem& problem,
                            const Parallel& parallel);

/// Lets a state begin anywhere in all recordings, or, `scale` 0, where they say.
void set_initial_scale(BoundSimulator& bound, std::size_t state, double scale);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/choose_initial_states.ipp"
#endif
