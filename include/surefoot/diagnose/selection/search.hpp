// Selection of effects by a floating forward-backward search (Pudil, Novovicova & Kittler, "Floating search methods in
// feature selection", 1994) with cross-validation. Effects mask each other: proposals are ranked anew after every step,
// and pairs are tried where no single effect is worth its parameters. Each fit starts from that of its parent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

struct Selection {
  EvaluatedHypothesis nominal;  // without effects
  EvaluatedHypothesis chosen;
  std::vector<Comparison> evidence;               // by chosen effect: against the choice without it
  std::vector<EvaluatedHypothesis> alternatives;  // one effect replaced, or none chosen: the best that was refused
  std::size_t candidates = 0;                     // how many were tried
};

/// Fits a parent with some proposals added, on the recordings for screening, from several starts; not ok if none of
/// them can be simulated.
Fit fit_child(const BoundSimulator& bound, const Hypothesis& parent, const std::vector<Proposal>& additions,
              const SearchProblem& problem);

/// Fits parent plus proposals, all at once in parallel; the weakest are given up after a few iterations.
std::vector<Fit> fit_children(const BoundSimulator& bound, const Hypothesis& parent,
                              const std::vector<std::vector<Proposal>>& additions, const SearchProblem& problem,
                              std::size_t keep, const Parallel& parallel);

/// Cross-validates the first `keep` fits and what ties with them; those with undetermined parameters are left out.
std::vector<EvaluatedHypothesis> evaluate_all(const BoundSimulator& bound, const std::vector<Fit>& fits,
                                              const EvaluatedHypothesis& parent, const SearchProblem& problem,
                                              std::size_t keep, const Parallel& parallel);

/// The best proposals beside `base`. Unless its residuals are `structured` only strong ones.
std::vector<Proposal> shortlisted(const BoundSimulator& bound, const Hypothesis& base, const SearchProblem& problem,
                                  const std::vector<AttachedEffect>& candidates, std::size_t count, bool structured,
                                  const Parallel& parallel);

Hypothesis without_effect(const Hypothesis& whole, std::size_t effect);

/// One round: the effects that would come next after `parent`, cross-validated; best fit first.
std::vector<EvaluatedHypothesis> next_effects(const BoundSimulator& bound, const EvaluatedHypothesis& parent,
                                              const SearchProblem& problem,
                                              const std::vector<AttachedEffect>& candidates, bool structured,
                                              const Parallel& parallel);

/// The same for pairs of the best proposals.
std::vector<EvaluatedHypothesis> next_pairs(const BoundSimulator& bound, const EvaluatedHypothesis& parent,
                                            const SearchProblem& problem, const std::vector<AttachedEffect>& candidates,
                                            const Parallel& parallel);

/// A search under way.
struct Search {
  const BoundSimulator& bound;
  const SearchProblem& problem;
  const std::vector<AttachedEffect>& candidates;
  const Parallel& parallel;

  std::size_t effects(const EvaluatedHypothesis& one) const { return one.hypothesis.effects.size() - problem.known; }
  /// Error of a hypothesis as a share of the error without effects.
  double share(const EvaluatedHypothesis& one, const EvaluatedHypothesis& nominal) const {
    return one.cross_validated.rms() / std::max(nominal.cross_validated.rms(), never_zero);
  }
  double tests() const { return static_cast<double>(candidates.size()); }
  EvaluatedHypothesis without(const EvaluatedHypothesis& whole, std::size_t effect) const;
};

/// Whatever is no longer worth its parameters goes.
void drop_idle_effects(const Search& search, EvaluatedHypothesis& chosen);

/// Adds effects until none is worth its parameters.
void add_effects(const Search& search, Selection& selection);

/// One effect that leaves something open may have hidden two that do better.
void try_pair_instead(const Search& search, Selection& selection);

/// What else might stand in the place of one effect beside the `rest`.
std::vector<EvaluatedHypothesis> rivals_of(const Search& search, const EvaluatedHypothesis& rest,
                                           const AttachedEffect& effect);

/// Each effect against what else might stand in its place; true if one was replaced. Fills in evidence and
/// alternatives.
bool compare_with_others(const Search& search, Selection& selection, bool replace);

/// The whole search, from a fitted hypothesis without effects.
Selection select_effects(const BoundSimulator& bound, const Fit& calibrated, const SearchProblem& problem,
                         const std::vector<AttachedEffect>& candidates, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/search.ipp"
#endif
