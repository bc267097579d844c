// Children of a structure in the search: the same with one effect more, or two. Each fit starts from that of its
// parent; many begin, the best are finished and evaluated.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

/// Fits a parent with some proposals added, on the recordings for screening, from several starts; not ok if none of
/// them can be simulated.
Fit fit_child(const BoundSimulator& bound, const Hypothesis& parent, const std::vector<Proposal>& additions,
              const SearchProblem& problem);

/// A search under way.
struct Search {
  const BoundSimulator& bound;
  SearchProblem problem;
  const std::vector<AttachedEffect>& candidates;
  const Parallel& parallel;

  std::size_t effects(const EvaluatedHypothesis& one) const { return one.hypothesis.effects.size() - problem.known; }
  EvaluatedHypothesis without(const EvaluatedHypothesis& whole, std::size_t effect) const;
};

/// A structure fitted once more from inside where a bound of an effect alone makes it improbable, at log odds of
/// `odds`, if that makes it more probable: where a scale is free, as of a tank that no sensor sees, or where the way to
/// what it is in truth is far, nothing but chance puts it there. Cost: two fits where so.
EvaluatedHypothesis inside_bounds(const Search& search, const EvaluatedHypothesis& one, double odds);

/// Finishes the `keep` best of some fits that have begun, and evaluates them.
std::vector<EvaluatedHypothesis> finished(const Search& search, std::vector<Fit> fits, std::size_t keep);

/// The same of fits that have yet to begin: each from its hypothesis.
std::vector<EvaluatedHypothesis> finished_from(const Search& search, std::vector<Fit> starts, std::size_t keep);

/// Fits the parent plus each of some sets of proposals, all at once in parallel; the weakest are given up after a few
/// iterations, the others are evaluated.
std::vector<EvaluatedHypothesis> evaluate_children(const Search& search, const EvaluatedHypothesis& parent,
                                                   const std::vector<std::vector<Proposal>>& additions,
                                                   std::size_t keep);

/// Effects that a parent has not yet, the most promising first.
std::vector<Proposal> proposals_for(const Search& search, const EvaluatedHypothesis& parent);

/// Share of the mean square that must fall for log odds to rise by so much [nat].
double gain_for(double odds, const ErrorSquares& errors);

/// Share of the squared residuals that `effects` more must explain to make a parent as probable as `best`, or nearly
/// so.
double needed_gain(const Search& search, const EvaluatedHypothesis& parent, const EvaluatedHypothesis& best,
                   std::size_t effects);

/// Leaves out proposals, or pairs of them, that would not explain `needed` even if they explained much more than their
/// signatures say.
template <class T>
void drop_what_cannot_pay(std::vector<T>& proposals, double needed, const SearchEffort& effort) {
  drop_items(proposals, [&](const T& one) { return one.gain * effort.underestimated < needed; });
}

/// The parent with one effect more: the best `finalists` of the first proposals, evaluated.
std::vector<EvaluatedHypothesis> next_effects(const Search& search, const EvaluatedHypothesis& parent,
                                              std::vector<Proposal> proposals, std::size_t shortlist,
                                              std::size_t finalists);

/// The parent with two effects more; pairs must be able to explain the share `needed`.
std::vector<EvaluatedHypothesis> next_pairs(const Search& search, const EvaluatedHypothesis& parent,
                                            const std::vector<Proposal>& proposals, double needed);

/// The same effect, in one form, at two places: `most` of these get a fit.
std::vector<EvaluatedHypothesis> next_tied_pairs(const Search& search, const EvaluatedHypothesis& parent,
                                                 const std::vector<Proposal>& proposals, std::size_t most);

/// Of best_structures: all, however far behind the best.
inline constexpr double none_is_hopeless = std::numeric_limits<double>::infinity();

/// The most plausible ones, best first, and none that is `hopeless` behind the best [nat].
std::vector<EvaluatedHypothesis> best_structures(std::vector<EvaluatedHypothesis> pool, std::size_t count,
                                                 double hopeless, const SelectionCriteria& criteria);

/// Pairs of the best single effects: neither may be the one that would be chosen alone.
std::vector<EvaluatedHypothesis> combined(const Search& search, const std::vector<EvaluatedHypothesis>& singles);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/children.ipp"
#endif
