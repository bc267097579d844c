// Rivals of the best structure: what may stand in the place of its effects.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Share of the squared residuals that a rival must promise to stand in the place of an effect of the best structure:
/// as much as makes it as probable, but no more than that effect itself promises among `proposals`. Signatures say
/// little where friction holds a machine, and as little of all. `rest` is the best structure without that effect.
double needed_instead(const Search& search, const EvaluatedHypothesis& rest, const EvaluatedHypothesis& best,
                      std::size_t effect, const std::vector<Proposal>& proposals);

/// Takes each effect of the best structure away, and puts others in its place; not where what is left is one of those
/// that are `done`, which were extended already. It is done after that.
void swap_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done);

/// The same of two effects on inputs or signals at once, by one that is like them and acts on two inputs: two wheels
/// that are limited are no limited speed and turn, but neither one of them is better alone.
void swap_pairs_of_inputs(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// A rival of the best structure, which may need finer steps than that one to show what it is worth: where it is better
/// with these, all of the pool is simulated so from then on. Cost: what choosing steps for the rival takes, and two
/// fits where they are finer.
void weigh_with_its_own_steps(Search& search, const EvaluatedHypothesis& rival, const EvaluatedHypothesis& best,
                              std::vector<EvaluatedHypothesis>& pool);

/// Puts other effects in the place of each of the best structure, beside the parameters that were found with it: those
/// it may be confused with, its other forms, and itself elsewhere; and takes each away beside the others in their other
/// forms, which it may only have mended. Where the search began the parameters were so far off that a right effect may
/// have looked like the wrong one.
void try_confusable(Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Puts effects of other good structures in the place of those of the best one, and what its own come to without some
/// of their parameters, with the parameters that they were found with: what goes together may have been found apart.
/// Where a parameter of the one can nearly imitate the other, no signature says so.
void exchange_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Further effects of the best structure, from the nominal parameters of the model on, where one of these was driven to
/// a bound: it makes up for what is still missing, and so far off that nothing helps from there. Only what then leaves
/// no more than noise counts.
void extend_from_nominal(Search search, std::vector<EvaluatedHypothesis>& pool);

/// Single effects and pairs once more, from the parameters of the best structure on: these are nearest to the truth,
/// whatever effects led there, and an early choice that only led there is left behind.
void begin_anew(const Search& search, std::vector<EvaluatedHypothesis>& pool);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/rivals.ipp"
#endif
