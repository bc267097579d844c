// Selects effects by a floating forward-backward search (Pudil, Novovicova & Kittler, "Floating search methods in
// feature selection", 1994) on held-out recordings. Effects mask each other: proposals are ranked anew after every
// step, and pairs are tried where no single effect is worth its parameters. Each fit starts from that of its parent.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
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

/// Fits parent plus proposals, all at once in parallel; the weakest are given up after a few iterations.
std::vector<Fit> fit_children(const BoundSimulator& bound, const Hypothesis& parent,
                              const std::vector<std::vector<Proposal>>& additions, const SearchProblem& problem,
                              std::size_t keep, const Parallel& parallel);

std::vector<EvaluatedHypothesis> evaluate_all(const BoundSimulator& bound, const std::vector<Fit>& fits,
                                              const EvaluatedHypothesis& parent, const SearchProblem& problem,
                                              std::size_t keep, const Parallel& parallel);

std::vector<Proposal> shortlisted(const BoundSimulator& bound, const Hypothesis& base, const SearchProblem& problem,
                                  const std::vector<AttachedEffect>& candidates, std::size_t count, double least_gain,
                                  const Parallel& parallel);

Hypothesis without_effect(const Hypothesis& whole, std::size_t effect);

/// What a proposal must explain of the squared residuals before it gets a fit.
inline double least_gain(bool structured) { return structured ? 0.002 : 0.012; }

/// One round: the effects (or pairs) that would come next after `parent`, judged; best first.
std::vector<EvaluatedHypothesis> next_effects(const BoundSimulator& bound, const EvaluatedHypothesis& parent,
                                              const SearchProblem& problem,
                                              const std::vector<AttachedEffect>& candidates,
                                              const SelectionCriteria& options, double least, const Parallel& parallel);

/// The same for pairs of the six best proposals.
std::vector<EvaluatedHypothesis> next_pairs(const BoundSimulator& bound, const EvaluatedHypothesis& parent,
                                            const SearchProblem& problem, const std::vector<AttachedEffect>& candidates,
                                            const Parallel& parallel);

/// A search under way.
struct Search {
  const BoundSimulator& bound;
  const SearchProblem& problem;
  const std::vector<AttachedEffect>& candidates;
  const SelectionCriteria& options;
  const Parallel& parallel;

  std::size_t effects(const EvaluatedHypothesis& one) const { return one.hypothesis.effects.size() - problem.known; }
  double share(const EvaluatedHypothesis& one, const EvaluatedHypothesis& nominal) const {
    return one.heldout.rms() / std::max(nominal.heldout.rms(), 1e-300);
  }
  EvaluatedHypothesis without(const EvaluatedHypothesis& whole, std::size_t effect) const {
    return judge(bound, fit(bound, without_effect(whole.hypothesis, effect), problem.fit, parallel), problem, parallel);
  }
};

/// Whatever is no longer worth its numbers goes.
void drop_idle_effects(const Search& search, EvaluatedHypothesis& chosen);

/// Adds effects until none is worth its numbers.
void grow(const Search& search, Selection& selection);

/// One effect that leaves something open may have hidden two that do better.
void try_pair_instead(const Search& search, Selection& selection);

/// Each effect against what else might stand in its place; true if one was replaced. Fills in evidence and
/// alternatives.
bool compare_with_others(const Search& search, Selection& selection, bool replace);

/// The whole search, from a fitted hypothesis without effects.
Selection select_effects(const BoundSimulator& bound, const Fit& calibrated, const SearchProblem& problem,
                         const std::vector<AttachedEffect>& candidates, const SelectionCriteria& options,
                         const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/search.ipp"
#endif
