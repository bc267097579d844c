// Selection of effects by a beam search: the best structures found so far are each extended by a further effect, or by
// a pair where no single one is worth its parameters; then effects of the best are taken away and replaced in turn.
// Every structure that was fitted is ranked in the end (see criterion.hpp), whatever way led to it. Weights follow what
// the best one so far leaves.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/ranking.hpp"

namespace surefoot::diagnosis {

/// The best structures of a pool fitted again, the very best ones also from places around.
void refit_best(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Takes each effect of the structures next to the best away: what only led to the others is not needed any more.
void take_effects_away(const Search& search, std::vector<EvaluatedHypothesis>& pool);

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
/// come near the best of it. True if the best then leaves no more than noise, with weights by what it leaves: what the
/// earlier search compared with it need not be compared again.
bool take_up(Search& search, const std::vector<Hypothesis>& begun, std::vector<EvaluatedHypothesis>& pool);

/// The whole search, from a fitted hypothesis without effects and from `begun`, what an earlier search found.
Selection select_effects(const BoundSimulator& bound, const Fit& calibrated, SearchProblem problem,
                         const std::vector<AttachedEffect>& candidates, const Parallel& parallel,
                         const std::vector<Hypothesis>& begun = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/search.ipp"
#endif
