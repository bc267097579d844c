// Definitions of surefoot/diagnose/selection/search.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/restarts.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/predictions.hpp"
#include "surefoot/diagnose/selection/richer_forms.hpp"
#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

/// Whether a form leaves no more with fewer parameters. Odds alone may still prefer the other one, whose parameters are
/// hardly known: much of their prior fits.
SUREFOOT_ONCE bool dominates(const EvaluatedHypothesis& one, const EvaluatedHypothesis& other) {
  return one.parameter_count() < other.parameter_count() && one.errors.rms() <= other.errors.rms();
}

SUREFOOT_ONCE bool keep_best_form(std::vector<EvaluatedHypothesis>& pool, const EvaluatedHypothesis& one,
                                  const SelectionCriteria& criteria) {
  for (EvaluatedHypothesis& other : pool) {
    if (!same_structure(other.hypothesis, one.hypothesis)) continue;
    const bool better =
        dominates(one, other) || (!dominates(other, one) && log_odds_of_forms(one, other, criteria) > 0);
    if (better) other = one;
    return better;
  }
  pool.push_back(one);
  return true;
}

SUREFOOT_ONCE void reweight(Search& search, const EvaluatedHypothesis& best) {
  FitProblem& problem = search.problem.fit;
  const auto runs =
      simulate_all(search.bound, best.hypothesis, problem.recordings, problem.integration, search.parallel);
  const Eigen::VectorXd sizes = residual_sizes(search.bound, problem.recordings, runs);
  for (Eigen::Index k = 0; k < sizes.size(); ++k) {
    const double least = search.problem.criteria.least_error * search.problem.scale.sigma[k];
    problem.weighting.sigma[k] = std::max(sizes[k], least);
  }
  problem.weighting.scale = recording_scales(search.bound, problem, runs);
  search.problem.screened = some_by_error(search.bound, problem.recordings, runs, search.problem.screened.size());
}

/// Whether a hypothesis leaves more than noise: what leaves only noise needs no second effect, nor another start.
SUREFOOT_ONCE bool leaves_structure(const Search& search, const EvaluatedHypothesis& one) {
  return search.problem.structured(one.hypothesis, search.problem.fit);
}

/// Richer forms for the best structures, none of them `hopeless` behind the best [nat].
SUREFOOT_ONCE void enrich(const Search& search, std::vector<EvaluatedHypothesis>& pool, double hopeless) {
  const auto& [bound, problem, candidates, parallel] = search;
  for (const EvaluatedHypothesis& one : best_structures(pool, problem.effort.finalists, hopeless, problem.criteria)) {
    if (problem.stopped()) return;
    if (const auto richer = in_richer_forms(search, one)) keep_best_form(pool, *richer, problem.criteria);
  }
}

/// The children of one parent into the pool of children; no fits for what cannot come near the best structure so far.
SUREFOOT_ONCE void extend(const Search& search, const EvaluatedHypothesis& parent, const EvaluatedHypothesis& best,
                          std::vector<EvaluatedHypothesis>& children) {
  const SearchProblem& problem = search.problem;
  const auto most = static_cast<std::size_t>(problem.criteria.max_effects);
  const bool structured = leaves_structure(search, parent);
  std::vector<Proposal> proposals = proposals_for(search, parent);
  if (!structured) {
    std::erase_if(proposals,
                  [&](const Proposal& one) { return one.gain < problem.criteria.unstructured_proposal_gain; });
  }
  const bool first = search.effects(best) == 0;
  const SearchEffort& effort = problem.effort;
  // the calibrated parameters may be far off, so that signatures of first effects say little
  std::vector<Proposal> singles = proposals;
  if (!first) drop_what_cannot_pay(singles, needed_gain(search, parent, best, 1), effort);
  const std::size_t shortlist = first ? effort.shortlist : std::min(effort.shortlist, effort.further_shortlist);
  const std::size_t finalists = first ? effort.finalists : effort.further_finalists;
  bool enough = false;
  for (const EvaluatedHypothesis& child : next_effects(search, parent, std::move(singles), shortlist, finalists)) {
    const bool better = log_odds(child, parent, problem.criteria) > 0;
    enough = enough || (better && (!first || !leaves_structure(search, child)));
    keep_best_form(children, child, problem.criteria);
  }
  const bool room = search.effects(parent) + 2 <= most;
  if (!structured || !room || enough || problem.stopped()) return;
  const double needed = first ? 0 : needed_gain(search, parent, best, 2);
  for (const EvaluatedHypothesis& child : next_pairs(search, parent, proposals, needed)) {
    keep_best_form(children, child, problem.criteria);
  }
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extended(const Search& search,
                                                        const std::vector<EvaluatedHypothesis>& beam,
                                                        const EvaluatedHypothesis& best) {
  std::vector<EvaluatedHypothesis> children;
  for (const EvaluatedHypothesis& parent : beam) {
    if (!search.problem.stopped()) extend(search, parent, best, children);
  }
  return children;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extended_from(Search search, Hypothesis start,
                                                             const EvaluatedHypothesis* best) {
  std::vector<EvaluatedHypothesis> children;
  if (search.problem.stopped()) return children;
  start.effects.resize(search.problem.known);
  start.values.resize(search.problem.known);
  const EvaluatedHypothesis bare = evaluate_fit(search.bound, Fit{start, 0, true}, search.problem, search.parallel);
  reweight(search, bare);
  search.problem.scatter = false;
  extend(search, bare, best != nullptr ? *best : bare, children);
  return children;
}

/// A hypothesis, fitted and evaluated again.
SUREFOOT_ONCE EvaluatedHypothesis refitted(const Search& search, const Hypothesis& one) {
  return evaluate_fit(search.bound, fit(search.bound, one, search.problem.fit, serially()), search.problem, serially());
}

SUREFOOT_ONCE void begin_elsewhere(Search search, std::vector<EvaluatedHypothesis>& children) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const auto done = [&] {
    return !children.empty() && !leaves_structure(search, children[best_of(children, criteria)]);
  };
  if (done()) return;
  try_around(search, children);  // other effects would mend a fit that ended in a valley
  if (!children.empty()) {
    EvaluatedHypothesis& best = children[best_of(children, criteria)];
    reweight(search, best);
    refine_integration(search, best);
    best = refitted(search, best.hypothesis);
    if (done()) return;
  }
  for (const EvaluatedHypothesis& child : extended_from(search, search.problem.nominal, nullptr)) {
    keep_best_form(children, child, criteria);
  }
  if (criteria.max_effects < 2 || children.empty() || done()) return;
  for (const EvaluatedHypothesis& pair : combined(search, children)) keep_best_form(children, pair, criteria);
}

SUREFOOT_ONCE bool refine_integration(Search& search, const EvaluatedHypothesis& best) {
  FitProblem& problem = search.problem.fit;
  const auto finer = finer_integration(search.bound, best.hypothesis, problem.weighting.sigma, problem.integration,
                                       problem.recordings, search.parallel);
  if (finer) problem.integration = *finer;
  return finer.has_value();
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> smaller(const Search& search, const EvaluatedHypothesis& whole) {
  const SearchProblem& problem = search.problem;
  std::vector<EvaluatedHypothesis> rests;
  if (search.effects(whole) < 2) return rests;
  for (std::size_t e = problem.known; e < whole.hypothesis.effects.size() && !problem.stopped(); ++e) {
    rests.push_back(search.without(whole, e));
  }
  return rests;
}

SUREFOOT_ONCE void take_effects_away(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  const auto best = best_structures(pool, problem.effort.beam, problem.effort.hopeless, problem.criteria);
  for (std::size_t i = 1; i < best.size(); ++i) {
    for (const EvaluatedHypothesis& rest : smaller(search, best[i])) keep_best_form(pool, rest, problem.criteria);
  }
}

SUREFOOT_ONCE bool yields(const Search& search, const std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const auto none = std::find_if(pool.begin(), pool.end(), [&](const auto& one) { return search.effects(one) == 0; });
  return none != pool.end() && log_odds(pool[best_of(pool, criteria)], *none, criteria) < search.problem.rival;
}

/// Whether two hypotheses have the same effects in the same forms.
SUREFOOT_ONCE bool same_effects(const Hypothesis& a, const Hypothesis& b) {
  return a.effects.size() == b.effects.size() &&
         std::is_permutation(a.effects.begin(), a.effects.end(), b.effects.begin(), same_effect);
}

SUREFOOT_ONCE void grow(Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const SearchEffort& effort = search.problem.effort;
  std::vector<EvaluatedHypothesis> beam = best_structures(pool, effort.beam, effort.hopeless, criteria);
  bool in_vain = false;  // a first step that does not pay may lead to one that does; two in a row do not
  for (int depth = 0; depth < criteria.max_effects && !search.problem.stopped(); ++depth) {
    search.problem.on_progress("searching effect " + std::to_string(depth + 1),
                               static_cast<double>(depth) / criteria.max_effects);
    const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
    const auto most = static_cast<std::size_t>(criteria.max_effects);
    std::erase_if(beam, [&](const EvaluatedHypothesis& one) {
      return search.effects(one) >= most || std::any_of(done.begin(), done.end(), [&](const Hypothesis& other) {
               return same_effects(one.hypothesis, other);
             });
    });
    for (const EvaluatedHypothesis& one : beam) done.push_back(one.hypothesis);
    std::vector<EvaluatedHypothesis> children = extended(search, beam, best);
    if (search.effects(best) == 0 && depth == 0) begin_elsewhere(search, children);
    enrich(search, children, std::numeric_limits<double>::infinity());
    for (const EvaluatedHypothesis& child : children) keep_best_form(pool, child, criteria);
    if (depth == 0 && yields(search, pool)) break;
    const EvaluatedHypothesis now = pool[best_of(pool, criteria)];
    const bool no_better = same_structure(now.hypothesis, best.hypothesis);
    if (no_better && (in_vain || search.effects(now) > 0 || !leaves_structure(search, now))) break;
    in_vain = no_better;
    std::erase_if(children, [&](const EvaluatedHypothesis& one) {
      return holds_idle_effect(one, pool) || log_odds(one, now, criteria) < -effort.hopeless;
    });
    beam = best_structures(children, effort.beam, effort.hopeless, criteria);
    if (beam.empty()) break;
    reweight(search, now);
    Fit fitted{now.hypothesis, now.loss, true};
    const bool holds = choose_holds(search.bound, fitted, search.problem, search.parallel);
    const bool otherwise = refine_integration(search, now) || holds;
    if (otherwise) {
      pool = fitted_again(search, pool);  // compared with the same errors
      done.clear();
    }
    for (EvaluatedHypothesis& one : beam) {            // and with the weights of their children
      const auto again = std::find_if(pool.begin(), pool.end(), [&](const EvaluatedHypothesis& other) {
        return same_structure(other.hypothesis, one.hypothesis);
      });
      if (otherwise && again != pool.end()) {
        one = *again;
      } else {
        one = refitted(search, one.hypothesis);
        keep_best_form(pool, one, criteria);
      }
    }
    if (no_better) continue;
    for (const EvaluatedHypothesis& rest : smaller(search, pool[best_of(pool, criteria)])) {
      const bool hopeless = log_odds(rest, now, criteria) < -effort.hopeless;
      if (keep_best_form(pool, rest, criteria) && !hopeless) beam.push_back(rest);
    }
  }
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> fitted_again(const Search& search,
                                                            const std::vector<EvaluatedHypothesis>& pool) {
  const SearchEffort& effort = search.problem.effort;
  std::vector<EvaluatedHypothesis> best =
      best_structures(pool, effort.finalists, effort.hopeless, search.problem.criteria);
  const bool has_none =
      std::any_of(best.begin(), best.end(), [&](const auto& one) { return search.effects(one) == 0; });
  for (const EvaluatedHypothesis& one : pool) {
    if (!has_none && search.effects(one) == 0) best.push_back(one);
  }
  search.parallel(best.size(), [&](std::size_t i) { best[i] = refitted(search, best[i].hypothesis); });
  return best;
}

SUREFOOT_ONCE void try_around(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  constexpr std::uint64_t restart_seed = 1;
  const SearchProblem& problem = search.problem;
  FitProblem quick = problem.fit;
  quick.recordings = problem.screened;
  quick.max_iterations = problem.effort.restart_iterations;
  constexpr double none_is_hopeless = std::numeric_limits<double>::infinity();
  for (const EvaluatedHypothesis& one :
       best_structures(pool, problem.effort.restarted, none_is_hopeless, problem.criteria)) {
    const bool calibrated = search.effects(one) == 0;  // from many places, before the search
    if (problem.stopped() || calibrated || !leaves_structure(search, one)) continue;
    const Fit fitted = fit(search.bound, one.hypothesis, problem.fit, search.parallel);  // with the present weights
    Fit again =
        restarted_fit(search.bound, fitted, problem.fit, quick, problem.effort.restarts, restart_seed, search.parallel);
    again = grown_fit(search.bound, again, again.hypothesis, problem.fit, search.parallel);
    again = guided_fit(search.bound, again, again.hypothesis, problem.fit, search.parallel);
    if (!(again.loss < fitted.loss)) continue;
    keep_best_form(pool, evaluate_fit(search.bound, again, problem, search.parallel), problem.criteria);
  }
}

SUREFOOT_ONCE void refit_best(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  if (search.problem.stopped()) return;
  for (const EvaluatedHypothesis& one : fitted_again(search, pool)) {
    keep_best_form(pool, one, search.problem.criteria);
  }
  try_around(search, pool);
}

SUREFOOT_ONCE void swap_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  constexpr double progress = 0.8;  // of the search
  const SearchProblem& problem = search.problem;
  const EvaluatedHypothesis best = pool[best_of(pool, problem.criteria)];
  for (std::size_t e = problem.known; e < best.hypothesis.effects.size() && !problem.stopped(); ++e) {
    problem.on_progress("comparing alternatives", progress);
    const EvaluatedHypothesis rest = search.without(best, e);
    keep_best_form(pool, rest, problem.criteria);
    if (search.effects(best) == 1) continue;  // its rivals were evaluated when it was chosen
    std::vector<Proposal> proposals = proposals_for(search, rest);
    drop_what_cannot_pay(proposals, needed_gain(search, rest, best, 1), problem.effort);
    const std::string& name = best.hypothesis.effects[e].effect->name;  // the right name may be at a wrong place
    std::stable_partition(proposals.begin(), proposals.end(),
                          [&](const Proposal& one) { return one.effect.effect->name == name; });
    for (const EvaluatedHypothesis& other :
         next_effects(search, rest, std::move(proposals),
                      std::min(problem.effort.compared_shortlist, problem.effort.further_shortlist),
                      problem.effort.compared_finalists)) {
      keep_best_form(pool, other, problem.criteria);
    }
  }
}

/// Whether the catalogue says that one of two effects may be taken for the other.
SUREFOOT_ONCE bool may_be_confused(const Effect& a, const Effect& b) {
  const auto says = [](const Effect& one, const std::string& name) {
    return std::find(one.confusable_with.begin(), one.confusable_with.end(), name) != one.confusable_with.end();
  };
  return says(a, b.name) || says(b, a.name);
}

/// Whether two effects have one name, or may be taken for each other.
SUREFOOT_ONCE bool is_like(const Effect& a, const Effect& b) { return a.name == b.name || may_be_confused(a, b); }

SUREFOOT_ONCE void swap_pairs_of_inputs(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  const EvaluatedHypothesis best = pool[best_of(pool, problem.criteria)];
  const auto acts_on_input = [](const AttachedEffect& one) { return one.effect->place == Place::input; };
  const auto& effects = best.hypothesis.effects;
  for (std::size_t e = problem.known; e < effects.size(); ++e) {
    for (std::size_t f = e + 1; f < effects.size() && !problem.stopped(); ++f) {
      if (!acts_on_input(effects[e]) || !acts_on_input(effects[f]) || !leaves_structure(search, best)) continue;
      const Hypothesis rest = without_effect(without_effect(best.hypothesis, f), e);
      const EvaluatedHypothesis parent =
          evaluate_fit(search.bound, fit(search.bound, rest, problem.fit, search.parallel), problem, search.parallel);
      std::vector<Proposal> proposals = proposals_for(search, parent);
      std::erase_if(proposals, [&](const Proposal& one) {
        const bool signal = one.effect.at >= static_cast<int>(search.bound.info.inputs.size());
        return !acts_on_input(one.effect) || signal ||
               (!is_like(*one.effect.effect, *effects[e].effect) && !is_like(*one.effect.effect, *effects[f].effect));
      });
      for (const EvaluatedHypothesis& other : next_tied_pairs(search, parent, proposals)) {
        keep_best_form(pool, other, problem.criteria);
      }
    }
  }
}

SUREFOOT_ONCE void try_confusable(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  SearchProblem problem = search.problem;
  problem.scatter = false;  // the parameters are near enough
  const EvaluatedHypothesis best = pool[best_of(pool, problem.criteria)];
  for (std::size_t e = problem.known; e < best.hypothesis.effects.size() && !problem.stopped(); ++e) {
    const AttachedEffect& found = best.hypothesis.effects[e];
    std::vector<AttachedEffect> others, same_name;  // each get their own finalists: forms would crowd the others out
    for (const AttachedEffect& one : search.candidates) {
      if (may_be_confused(*one.effect, *found.effect)) others.push_back(one);
      if (one.effect->name == found.effect->name && !same_effect(one, found)) same_name.push_back(one);
    }
    const Fit without{without_effect(best.hypothesis, e), 0, true};
    const EvaluatedHypothesis rest = evaluate_fit(search.bound, without, problem, search.parallel);
    for (const std::vector<AttachedEffect>& rivals : {others, same_name}) {
      const Search among{search.bound, problem, rivals, search.parallel};
      std::vector<EvaluatedHypothesis> fitted =
          next_effects(among, rest, proposals_for(among, rest), rivals.size(), problem.effort.compared_finalists);
      enrich(search, fitted, std::numeric_limits<double>::infinity());
      for (const EvaluatedHypothesis& one : fitted) keep_best_form(pool, one, problem.criteria);
    }
  }
}

SUREFOOT_ONCE void begin_anew(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
  if (search.effects(best) < 2) return;  // the search began with single effects
  for (const EvaluatedHypothesis& child : extended_from(search, best.hypothesis, &best)) {
    keep_best_form(pool, child, criteria);
  }
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
    if (inputs[i].hold.has_value() || found[i] == InputHold::zero_order) continue;
    const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
    Search held = search;
    held.problem.fit.integration.inputs[i] = InputHold::zero_order;
    const EvaluatedHypothesis without = refitted_or_smaller(held, best);
    if (log_odds(best, without, criteria) > std::log(criteria.named_odds)) continue;
    search.problem.fit.integration = held.problem.fit.integration;
    pool = fitted_again(search, pool);
    keep_best_form(pool, without, criteria);
    changed = true;
  }
  return changed;
}

SUREFOOT_ONCE void take_up(const Search& search, const std::vector<Hypothesis>& begun,
                           std::vector<EvaluatedHypothesis>& pool) {
  if (begun.empty()) return;
  const SelectionCriteria& criteria = search.problem.criteria;
  const EvaluatedHypothesis bare = pool.front();
  for (const Hypothesis& one : begun) {
    if (search.problem.stopped()) return;
    keep_best_form(pool, refitted(search, one), criteria);
  }
  const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
  if (search.effects(best) == 0) return;
  std::vector<EvaluatedHypothesis> children;
  extend(search, bare, best, children);
  for (const EvaluatedHypothesis& child : children) keep_best_form(pool, child, criteria);
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
  take_up(search, begun, pool);
  std::vector<Hypothesis> done;
  grow(search, pool, done);
  if (yields(search, pool)) {
    Selection selection = ranked(search, pool);
    selection.yields = true;
    selection.fit = search.problem.fit;
    return selection;
  }
  Hypothesis grown = pool[best_of(pool, criteria)].hypothesis;
  for (int round = 0; round < 2 && search.effects(pool[best_of(pool, criteria)]) > 0; ++round) {
    reweight(search, pool[best_of(pool, criteria)]);
    refit_best(search, pool);
    enrich(search, pool, search.problem.effort.hopeless);
    if (take_back_holds(search, pool)) done.clear();
    take_effects_away(search, pool);
    const Hypothesis compared = pool[best_of(pool, criteria)].hypothesis;
    const auto unchanged = [&] { return same_structure(pool[best_of(pool, criteria)].hypothesis, compared); };
    swap_effects(search, pool);
    swap_pairs_of_inputs(search, pool);
    try_confusable(search, pool);
    begin_anew(search, pool);
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
    std::erase_if(pool, [&](const EvaluatedHypothesis& one) {
      return same_structure(one.hypothesis, selection.chosen.hypothesis);
    });
    keep_best_form(pool, *fewer, criteria);
  }
  selection.fit = search.problem.fit;
  return selection;
}

}  // namespace surefoot::diagnosis
