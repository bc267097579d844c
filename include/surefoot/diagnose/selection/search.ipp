// Definitions of surefoot/diagnose/selection/search.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
#include "surefoot/diagnose/selection/grow.hpp"
#include "surefoot/diagnose/selection/predictions.hpp"
#include "surefoot/diagnose/selection/rivals.hpp"
#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE void take_effects_away(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  const auto best = best_structures(pool, problem.effort.beam, problem.effort.hopeless, problem.criteria);
  for (std::size_t i = 1; i < best.size(); ++i) {
    for (const EvaluatedHypothesis& rest : smaller(search, best[i])) keep_best_form(pool, rest, problem.criteria);
  }
}

SUREFOOT_ONCE void refit_best(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  if (search.problem.stopped()) return;
  for (const EvaluatedHypothesis& one : fitted_again(search, pool)) {
    keep_best_form(pool, one, search.problem.criteria);
  }
  try_around(search, pool);
}

SUREFOOT_ONCE std::vector<std::size_t> informative(const BoundSimulator& bound, const Hypothesis& calibrated,
                                                   const SearchProblem& problem, const Parallel& parallel) {
  const auto& all = problem.fit.recordings;
  double rows = 0;
  for (const std::size_t r : all) rows += static_cast<double>(bound.recordings[r].rows());
  const double share = static_cast<double>(problem.effort.rows) / std::max(rows, 1.0);
  if (share >= 1) return all;
  const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all.size())));
  const auto runs = simulate_all(bound, calibrated, all, problem.fit.integration, parallel);
  return some_by_error(bound, all, runs, std::max(std::min(problem.screened.size(), all.size()), count));
}

/// Weights by what the chosen effects leave, and the fit with these, in turn: as a model without effects is calibrated,
/// so that the augmented model, read back, is fitted to the same.
SUREFOOT_ONCE void settle(Search& search, EvaluatedHypothesis& chosen) {
  constexpr int reweightings = 2;  // as many as of a calibration
  for (int round = 0; round < reweightings && search.effects(chosen) > 0 && !search.problem.stopped(); ++round) {
    reweight(search, chosen);
    chosen = refitted(search, chosen.hypothesis);
  }
}

SUREFOOT_ONCE std::optional<EvaluatedHypothesis> weigh_effects(const Search& search, Selection& selection) {
  const EvaluatedHypothesis& chosen = selection.chosen;
  for (std::size_t e = search.problem.known; e < chosen.hypothesis.effects.size(); ++e) {
    const bool only = search.effects(chosen) == 1;
    const EvaluatedHypothesis rest = only ? selection.nominal : search.without(chosen, e);
    const double odds = log_odds(chosen, rest, search.problem.criteria);
    if (!only && odds < 0) return rest;
    selection.evidence.push_back(gain_of(rest.errors, chosen.errors, odds));
  }
  return std::nullopt;
}

/// A structure, fitted again, or that without one of its effects if it is as probable.
SUREFOOT_ONCE EvaluatedHypothesis refitted_or_smaller(const Search& search, const EvaluatedHypothesis& one) {
  std::vector<EvaluatedHypothesis> some{refitted(search, one.hypothesis)};
  for (std::size_t e = search.problem.known; e < one.hypothesis.effects.size() && !search.problem.stopped(); ++e) {
    some.push_back(search.without(some.front(), e));
  }
  return some[best_of(some, search.problem.criteria)];
}

SUREFOOT_ONCE bool take_back_holds(Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const std::vector<InputInfo>& inputs = search.bound.info.inputs;
  const std::vector<InputHold> found = search.problem.fit.integration.inputs;
  bool changed = false;
  for (std::size_t i = 0; i < found.size() && !search.problem.stopped(); ++i) {
    const InputHold said = inputs[i].hold.value_or(InputHold::zero_order);
    if (hold_of(search.bound.info, found, i) == said) continue;
    const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
    Search held = search;
    held.problem.fit.integration.inputs[i] = said;
    const EvaluatedHypothesis without = refitted_or_smaller(held, best);
    if (log_odds(best, without, criteria) > std::log(criteria.named_odds)) continue;
    search.problem.fit.integration = held.problem.fit.integration;
    pool = fitted_again(search, pool);
    keep_best_form(pool, without, criteria);
    changed = true;
  }
  return changed;
}

SUREFOOT_ONCE bool take_up(Search& search, const std::vector<Hypothesis>& begun,
                           std::vector<EvaluatedHypothesis>& pool) {
  if (begun.empty()) return false;
  const SelectionCriteria& criteria = search.problem.criteria;
  const EvaluatedHypothesis bare = pool.front();
  for (const Hypothesis& one : begun) {
    if (search.problem.stopped()) return false;
    keep_best_form(pool, refitted(search, one), criteria);
  }
  const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
  if (search.effects(best) == 0) return false;
  std::vector<EvaluatedHypothesis> children;
  extend(search, bare, best, children);
  for (const EvaluatedHypothesis& child : children) keep_best_form(pool, child, criteria);
  Search own = search;
  const EvaluatedHypothesis nearest = pool[best_of(pool, criteria)];
  reweight(own, nearest);
  refine_integration(own, nearest);
  if (search.effects(nearest) == 0 || leaves_structure(own, refitted(own, nearest.hypothesis))) return false;
  search.problem = own.problem;
  pool = fitted_again(search, pool);
  return true;
}

/// Where the best structure leaves no more than noise does it can be tied, but not beaten: from now on fits end where
/// they do not come near it.
SUREFOOT_ONCE void end_hopeless_fits(Search& search, const EvaluatedHypothesis& best) {
  if (leaves_structure(search, best)) return;
  FitProblem& problem = search.problem.fit;
  problem.reach = loss_of(search.bound, best.hypothesis, problem, search.parallel);
}

SUREFOOT_ONCE Selection select_effects(const BoundSimulator& bound, const Fit& calibrated, SearchProblem problem,
                                       const std::vector<AttachedEffect>& candidates, const Parallel& parallel,
                                       const std::vector<Hypothesis>& begun) {
  problem.candidates = candidates.size();
  Search search{bound, std::move(problem), candidates, parallel};
  const SelectionCriteria& criteria = search.problem.criteria;
  const std::vector<std::size_t> all = search.problem.fit.recordings;
  search.problem.fit.recordings = informative(bound, calibrated.hypothesis, search.problem, parallel);
  std::vector<EvaluatedHypothesis> pool{evaluate_fit(bound, calibrated, search.problem, parallel)};
  search.problem.least = pool.front().errors.least = negligible_differences(pool.front().errors, criteria);
  choose_screening(search, pool.front());
  const bool compared_before = take_up(search, begun, pool);
  std::vector<Hypothesis> done;
  if (!compared_before) grow(search, pool, done);
  if (yields(search, pool)) {
    Selection selection = ranked(search, pool);
    selection.yields = true;
    selection.fit = search.problem.fit;
    return selection;
  }
  Hypothesis grown = pool[best_of(pool, criteria)].hypothesis;
  const int rounds = compared_before ? 0 : 2;
  for (int round = 0; round < rounds && search.effects(pool[best_of(pool, criteria)]) > 0; ++round) {
    reweight(search, pool[best_of(pool, criteria)]);
    refit_best(search, pool);
    enrich(search, pool, search.problem.effort.hopeless, ErrorsOfForm::counted);
    if (take_back_holds(search, pool)) done.clear();
    end_hopeless_fits(search, pool[best_of(pool, criteria)]);
    take_effects_away(search, pool);
    const Hypothesis compared = pool[best_of(pool, criteria)].hypothesis;
    const auto unchanged = [&] { return same_structure(pool[best_of(pool, criteria)].hypothesis, compared); };
    swap_effects(search, pool, done);
    swap_pairs_of_inputs(search, pool);
    exchange_effects(search, pool);
    try_confusable(search, pool);
    begin_anew(search, pool);
    extend_from_nominal(search, pool);
    search.problem.fit.reach = 0;
    // what it lacks may not have helped the one that it was grown from
    const bool grows = !same_structure(compared, grown) || !unchanged();
    if (grows && leaves_structure(search, pool[best_of(pool, criteria)])) grow(search, pool, done);
    if (unchanged()) break;
    grown = pool[best_of(pool, criteria)].hypothesis;
  }
  if (search.problem.fit.recordings.size() < all.size()) {
    const bool finished = !leaves_structure(search, pool[best_of(pool, criteria)]);
    search.problem.fit.recordings = all;
    reweight(search, pool[best_of(pool, criteria)]);
    const EvaluatedHypothesis without_effects = evaluate_fit(bound, calibrated, search.problem, parallel);
    search.problem.least = negligible_differences(without_effects.errors, criteria);
    pool = fitted_again(search, pool);
    done.clear();  // the others show more
    if (finished && leaves_structure(search, pool[best_of(pool, criteria)])) grow(search, pool, done);
  }
  Selection selection;
  while (true) {
    selection = ranked(search, with_predictions(search, pool));
    restore_errors_of_fits(selection, pool);
    settle(search, selection.chosen);
    const auto fewer = weigh_effects(search, selection);
    if (!fewer) break;
    drop_items(pool, [&](const EvaluatedHypothesis& one) {
      return same_structure(one.hypothesis, selection.chosen.hypothesis);
    });
    keep_best_form(pool, *fewer, criteria);
  }
  selection.fit = search.problem.fit;
  return selection;
}

}  // namespace surefoot::diagnosis
