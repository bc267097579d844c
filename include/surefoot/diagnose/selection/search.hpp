// Selection of effects by a beam search: the best structures found so far are each extended by a further effect, or by
// a pair where no single one is worth its parameters; then effects of the best are taken away and replaced in turn.
// Every structure that was fitted is ranked in the end (see criterion.hpp), whatever way led to it. Weights follow what
// the best one so far leaves.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/ranking.hpp"

namespace surefoot::diagnosis {

/// Puts a hypothesis into the pool, in the place of another form of the same structure if it is better or leaves no more
/// with fewer parameters; true if it went in.
bool keep_best_form(std::vector<EvaluatedHypothesis>& pool, const EvaluatedHypothesis& one,
                    const SelectionCriteria& criteria);

/// Weights residuals of further fits by what a hypothesis leaves of each output and recording, and screens proposals on
/// the recordings that show this best.
void reweight(Search& search, const EvaluatedHypothesis& best);

/// What effects explain shows smaller errors of the integration, which would pass for further effects: chooses it anew
/// for what a hypothesis leaves; true if it is finer now.
bool refine_integration(Search& search, const EvaluatedHypothesis& best);

/// The children of the model without effects, but with the parameters and initial states of `start`: what is missing
/// may have pushed the calibrated ones where no fit finds back from, and where signatures look otherwise. With a `best`
/// structure so far, only what could come near it.
std::vector<EvaluatedHypothesis> extended_from(Search search, Hypothesis start, const EvaluatedHypothesis* best);

/// Where first effects leave more than noise: the best from places around, first effects from the nominal parameters
/// on, and pairs of the best.
void begin_elsewhere(Search search, std::vector<EvaluatedHypothesis>& children);

/// Whether the rival explanation of the problem does better than the best of a pool of first effects.
bool yields(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

/// Extends the best structures of a pool, as long as that makes the best one better; once more where no first effect
/// does and something is left. What the best one can do without is taken away at once (floating search; P. Pudil,
/// J. Novovicova, J. Kittler, Pattern Recognition Letters 15, 1994). Structures with an effect that does nothing, and
/// those far behind, are not extended, nor is what was before, which `done` keeps, with the same recordings and
/// integration.
void grow(Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done);

/// The best structures, and the model without effects, fitted and evaluated with the present weights and recordings.
std::vector<EvaluatedHypothesis> fitted_again(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

/// Fits the best of a pool from places around, with a growing horizon and under guidance, where they leave more than
/// noise: another effect would only mend a fit that ended in a valley.
void try_around(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// The best structures of a pool fitted again, the very best ones also from places around.
void refit_best(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// A structure without each of its effects in turn, fitted from its parameters on; none for a single effect.
std::vector<EvaluatedHypothesis> smaller(const Search& search, const EvaluatedHypothesis& whole);

/// Takes each effect of the structures next to the best away: what only led to the others is not needed any more.
void take_effects_away(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Takes each effect of the best structure away, and puts others in its place.
void swap_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// The same of two effects on inputs or signals at once, by one that is like them and acts on two inputs: two wheels
/// that are limited are no limited speed and turn, but neither one of them is better alone.
void swap_pairs_of_inputs(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Puts other effects in the place of each of the best structure, beside the parameters that were found with it: those
/// it may be confused with, its other forms, and itself elsewhere. Where the search began the parameters were so far
/// off that a right effect may have looked like the wrong one.
void try_confusable(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Single effects and pairs once more, from the parameters of the best structure on: these are nearest to the truth,
/// whatever effects led there, and an early choice that only led there is left behind.
void begin_anew(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// The evidence of each chosen effect into the selection. If one is not worth its parameters once all has settled (its
/// size may have gone to zero): the structure without it.
std::optional<EvaluatedHypothesis> weigh_effects(const Search& search, Selection& selection);

/// Recordings that the search looks at: of many only some, which differ in how far the calibrated model misses them.
std::vector<std::size_t> informative(const BoundSimulator& bound, const Hypothesis& calibrated,
                                     const SearchProblem& problem, const Parallel& parallel);

/// Takes inputs for held again that were found to go otherwise, unless the best structure needs that at the odds that
/// name an effect: what was missing then, and is found now, may look like it. An effect that only made up for it goes
/// with it. True if anything changed: the pool is fitted so.
bool take_back_holds(Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Into a pool that holds the model without effects what an earlier search found, fitted again, and first effects that
/// come near the best of it.
void take_up(const Search& search, const std::vector<Hypothesis>& begun, std::vector<EvaluatedHypothesis>& pool);

/// The whole search, from a fitted hypothesis without effects and from `begun`, what an earlier search found.
Selection select_effects(const BoundSimulator& bound, const Fit& calibrated, SearchProblem problem,
                         const std::vector<AttachedEffect>& candidates, const Parallel& parallel,
                         const std::vector<Hypothesis>& begun = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/search.ipp"
#endif
