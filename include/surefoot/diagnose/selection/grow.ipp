// Definitions of surefoot/diagnose/selection/grow.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/restarts.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/grow.hpp"
#include "surefoot/diagnose/selection/richer_forms.hpp"

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

SUREFOOT_ONCE bool leaves_structure(const Search& search, const EvaluatedHypothesis& one) {
  return search.problem.structured(one.hypothesis, search.problem.fit);
}

SUREFOOT_ONCE void enrich(const Search& search, std::vector<EvaluatedHypothesis>& pool, double hopeless) {
  const auto& [bound, problem, candidates, parallel] = search;
  for (const EvaluatedHypothesis& one : best_structures(pool, problem.effort.finalists, hopeless, problem.criteria)) {
    if (problem.stopped()) return;
    if (const auto richer = in_richer_forms(search, one)) keep_best_form(pool, *richer, problem.criteria);
  }
}

SUREFOOT_ONCE void extend(const Search& search, const EvaluatedHypothesis& parent, const EvaluatedHypothesis& best,
                          std::vector<EvaluatedHypothesis>& children) {
  const SearchProblem& problem = search.problem;
  const auto most = static_cast<std::size_t>(problem.criteria.max_effects);
  const bool structured = leaves_structure(search, parent);
  std::vector<Proposal> proposals = proposals_for(search, parent);
  if (!structured) {
    drop_items(proposals, [&](const Proposal& one) { return one.gain < problem.criteria.unstructured_proposal_gain; });
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
  if (first) {
    for (const EvaluatedHypothesis& child : next_tied_pairs(search, parent, proposals, effort.pairs)) {
      keep_best_form(children, child, problem.criteria);
    }
  }
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

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extended_under_guidance(const Search& search) {
  constexpr std::size_t reached = 2;  // of the horizons: short, but longer than one row
  const auto near = std::span(guided_horizons).first(reached), far = std::span(guided_horizons).subspan(reached);
  const FitProblem& problem = search.problem.fit;
  if (!can_be_guided(search.bound, problem)) return {};
  const Hypothesis start = guided(search.bound, search.problem.nominal, problem, near, search.parallel);
  Search followed = search;
  followed.problem.fit.integration.follow = guided_follow(search.bound, problem, near.back());
  std::vector<EvaluatedHypothesis> children = extended_from(followed, start, nullptr);
  search.parallel(children.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    children[i] = refitted(search, guided(search.bound, children[i].hypothesis, problem, far, serially()));
  });
  if (problem.stopped()) children.clear();  // errors of some are still those under guidance
  return children;
}

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
  for (const EvaluatedHypothesis& child : extended_under_guidance(search)) keep_best_form(children, child, criteria);
  if (done()) return;
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

SUREFOOT_ONCE bool yields(const Search& search, const std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const auto none = find_item(pool, [&](const auto& one) { return search.effects(one) == 0; });
  return none != nullptr && log_odds(pool[best_of(pool, criteria)], *none, criteria) < search.problem.rival;
}

/// Whether two hypotheses have the same effects in the same forms.
SUREFOOT_ONCE bool same_effects(const Hypothesis& a, const Hypothesis& b) {
  const auto as_often_in_both = [&](const AttachedEffect& one) {
    const auto is_same = [&](const AttachedEffect& other) { return same_effect(one, other); };
    return count_items(a.effects, is_same) == count_items(b.effects, is_same);
  };
  return a.effects.size() == b.effects.size() && holds_for_all(a.effects, as_often_in_both);
}

/// With the parameters of effects that are at bounds a tenth of their range inside, and all else fitted around them.
SUREFOOT_ONCE std::optional<Hypothesis> drawn_inside(const Search& search, Hypothesis one) {
  constexpr double inside = 0.1, middle = 0.5;  // of its range
  const SearchProblem& problem = search.problem;
  bool any = false;
  for (const Variable& variable : variables_of(search.bound, one, {})) {
    if (variable.kind != Variable::Kind::effect || variable.index < problem.known) continue;
    if (!is_at_bound(one, variable, problem.criteria)) continue;
    const double low = to_search(variable, variable.low), high = to_search(variable, variable.high);
    double& value = value_of(one, variable);
    const bool below = to_search(variable, value) < low + middle * (high - low);
    value = from_search(variable, below ? low + inside * (high - low) : high - inside * (high - low));
    any = true;
  }
  if (!any) return std::nullopt;
  FitProblem around = problem.fit;
  around.free = Free::all_but_effects;
  return fit(search.bound, one, around, serially()).hypothesis;
}

SUREFOOT_ONCE void draw_inside(const Search& search, const EvaluatedHypothesis& best,
                               std::vector<EvaluatedHypothesis>& children) {
  const SelectionCriteria& criteria = search.problem.criteria;
  for (EvaluatedHypothesis& child : children) {
    if (search.problem.stopped()) return;
    if (log_odds(child, best, criteria) + criteria.bound_cost < 0) continue;
    const auto inside = drawn_inside(search, child.hypothesis);
    if (!inside) continue;
    const EvaluatedHypothesis again = refitted(search, *inside);
    if (log_odds(again, child, criteria) > 0) child = again;
  }
}

/// The structure that leaves least, however many parameters that takes; none of none.
SUREFOOT_ONCE std::optional<EvaluatedHypothesis> least_left(const std::vector<EvaluatedHypothesis>& some) {
  const auto least = std::min_element(some.begin(), some.end(),
                                      [](const auto& a, const auto& b) { return a.errors.rms() < b.errors.rms(); });
  return least == some.end() ? std::nullopt : std::optional(*least);
}

/// Whether an effect takes away more than any further one does by chance.
SUREFOOT_ONCE bool much_less(double left, double before) {
  constexpr double share = 0.8;  // of the mean square: few independent errors bend by a tenth to any parameter
  return left * left < share * before * before;
}

SUREFOOT_ONCE void add_structure(std::vector<EvaluatedHypothesis>& some, const EvaluatedHypothesis& one) {
  const bool there = holds_for_any(
      some, [&](const EvaluatedHypothesis& other) { return same_structure(other.hypothesis, one.hypothesis); });
  if (!there) some.push_back(one);
}

SUREFOOT_ONCE bool pays(const Search& search, const EvaluatedHypothesis& one,
                        const std::vector<EvaluatedHypothesis>& pool) {
  const auto none = find_item(pool, [&](const auto& other) { return search.effects(other) == 0; });
  const bool less_probable = none != nullptr && log_odds(one, *none, search.problem.criteria) < 0;
  return search.effects(one) > 0 && !less_probable;
}

SUREFOOT_ONCE void add_with_smaller(const Search& search, const EvaluatedHypothesis& one,
                                    std::vector<EvaluatedHypothesis>& beam) {
  add_structure(beam, one);
  for (const EvaluatedHypothesis& rest : smaller(search, one)) {
    if (!much_less(one.errors.rms(), rest.errors.rms())) add_structure(beam, rest);
  }
}

SUREFOOT_ONCE void grow(Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const SearchEffort& effort = search.problem.effort;
  std::vector<EvaluatedHypothesis> beam = best_structures(pool, effort.beam, effort.hopeless, criteria);
  bool in_vain = false;  // a first step that does not pay may lead to one that does; two in a row only by coming nearer
  double nearest = pool[best_of(pool, criteria)].errors.rms();
  for (int depth = 0; depth < criteria.max_effects && !search.problem.stopped(); ++depth) {
    search.problem.on_progress("searching effect " + std::to_string(depth + 1),
                               static_cast<double>(depth) / criteria.max_effects);
    const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
    const auto most = static_cast<std::size_t>(criteria.max_effects);
    drop_items(beam, [&](const EvaluatedHypothesis& one) {
      return search.effects(one) >= most ||
             holds_for_any(done, [&](const Hypothesis& other) { return same_effects(one.hypothesis, other); });
    });
    for (const EvaluatedHypothesis& one : beam) done.push_back(one.hypothesis);
    std::vector<EvaluatedHypothesis> children = extended(search, beam, best);
    if (search.effects(best) == 0 && depth == 0) begin_elsewhere(search, children);
    enrich(search, children, std::numeric_limits<double>::infinity());
    draw_inside(search, best, children);
    for (const EvaluatedHypothesis& child : children) keep_best_form(pool, child, criteria);
    if (depth == 0 && yields(search, pool)) break;
    const EvaluatedHypothesis now = pool[best_of(pool, criteria)];
    const bool no_better = same_structure(now.hypothesis, best.hypothesis) || log_odds(now, best, criteria) < 0;
    const auto nearest_child = least_left(children);
    const bool nearer = nearest_child && much_less(nearest_child->errors.rms(), nearest);
    if (nearer) nearest = nearest_child->errors.rms();
    if (no_better && ((in_vain && !nearer) || pays(search, now, pool) || !leaves_structure(search, now))) break;
    in_vain = no_better;
    drop_items(children, [&](const EvaluatedHypothesis& one) {
      return holds_idle_effect(one, pool) || log_odds(one, now, criteria) < -effort.hopeless;
    });
    beam = best_structures(children, effort.beam, effort.hopeless, criteria);
    if (no_better && nearer) add_with_smaller(search, *nearest_child, beam);
    if (beam.empty()) break;
    reweight(search, now);
    Fit fitted{now.hypothesis, now.loss, true};
    const bool holds = choose_holds(search.bound, fitted, search.problem, search.parallel);
    const bool otherwise = refine_integration(search, now) || holds;
    if (otherwise) {
      pool = fitted_again(search, pool);  // compared with the same errors
      done.clear();
    }
    for (EvaluatedHypothesis& one : beam) {  // and with the weights of their children
      const auto again = find_item(
          pool, [&](const EvaluatedHypothesis& other) { return same_structure(other.hypothesis, one.hypothesis); });
      if (otherwise && again != nullptr) {
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
  const bool has_none = holds_for_any(best, [&](const auto& one) { return search.effects(one) == 0; });
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

}  // namespace surefoot::diagnosis
