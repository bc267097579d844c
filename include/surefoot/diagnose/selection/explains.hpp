// Explanations of the recordings: what a hypothesis leaves against what noise does, and against a rival explanation.
#pragma once

#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Whether a hypothesis leaves more than noise: what leaves only noise needs no second effect, nor another start.
bool leaves_structure(const Search& search, const EvaluatedHypothesis& one);

/// Whether a hypothesis leaves only noise, or so little more that an error of form may be all it is: no other start
/// could do better, though a further effect may.
bool explains(const Search& search, const EvaluatedHypothesis& one);

/// The loss at which a hypothesis would leave no more than noise does; an output of which that is not known counts as
/// it is.
double loss_at_noise(const EvaluatedHypothesis& one, const SearchProblem& problem);

/// Whether the rival explanation of the problem does better than the best of a pool, in which is the model without
/// effects.
bool yields(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/explains.ipp"
#endif
