// Definitions of surefoot/diagnose/selection/first_effects.hpp.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
#include "surefoot/diagnose/selection/first_effects.hpp"

namespace surefoot::diagnosis {

/// As extended_from; the search goes on with what settles an effect alone.
SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extend_from(Search& search, Hypothesis start,
                                                           const EvaluatedHypothesis* best) {
  std::vector<EvaluatedHypothesis> children;
  if (search.problem.stopped()) return children;
  start.effects.resize(search.problem.known);
  start.values.resize(search.problem.known);
  const EvaluatedHypothesis bare = evaluate_fit(search.bound, Fit{start, 0, true}, search.problem, search.parallel);
  reweight(search, bare);
  if (best != nullptr) choose_screening(search, bare);  // what the best leaves needs finer steps
  search.problem.fit.reach = 0;                         // in other units
  search.problem.scatter = false;
  extend(search, bare, best != nullptr ? *best : bare, children);
  return children;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extended_from(Search search, Hypothesis start,
                                                             const EvaluatedHypothesis* best) {
  return extend_from(search, std::move(start), best);
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extended_under_guidance(Search& search) {
  constexpr std::size_t reached = 2;  // of the horizons: short, but longer than one row
  const auto near = std::span(guided_horizons).first(reached), far = std::span(guided_horizons).subspan(reached);
  FitProblem& problem = search.problem.fit;
  if (!can_be_guided(search.bound, problem)) return {};
  const Hypothesis start = guided(search.bound, search.problem.nominal, problem, near, search.parallel);
  Search followed = search;
  followed.problem.fit.integration.follow = guided_follow(search.bound, problem, near.back());
  std::vector<EvaluatedHypothesis> children = extend_from(followed, start, nullptr);
  const double follow = problem.integration.follow;
  problem.integration = followed.problem.fit.integration;
  problem.integration.follow = follow;
  search.problem.screening = followed.problem.screening;
  search.parallel(children.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    children[i] = refitted(search, guided(search.bound, children[i].hypothesis, problem, far, serially()));
  });
  if (problem.stopped()) children.clear();  // errors of some are still those under guidance
  return children;
}

SUREFOOT_ONCE bool has_lost_readings(const EvaluatedHypothesis& one) {
  constexpr double share = 0.3;  // of the outputs' own deviations
  return one.errors.rms() > share;
}

/// As begin_elsewhere, in steps that change on the way.
SUREFOOT_ONCE void seek_elsewhere(Search& search, bool guided, std::vector<EvaluatedHypothesis>& children) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const auto done = [&] { return !children.empty() && explains(search, children[best_of(children, criteria)]); };
  if (done()) return;
  try_around(search, children);  // other effects would mend a fit that ended in a valley
  if (!children.empty()) {
    EvaluatedHypothesis& best = children[best_of(children, criteria)];
    reweight(search, best);
    refine_integration(search, best);
    best = refitted(search, best.hypothesis);
    if (done()) return;
  }
  if (!guided) {
    for (const EvaluatedHypothesis& child : extended_under_guidance(search)) keep_best_form(children, child, criteria);
    if (done()) return;
  }
  for (const EvaluatedHypothesis& child : extended_from(search, search.problem.nominal, nullptr)) {
    keep_best_form(children, child, criteria);
  }
  if (criteria.max_effects < 2 || children.empty() || done()) return;
  for (const EvaluatedHypothesis& pair : combined(search, children)) keep_best_form(children, pair, criteria);
}

SUREFOOT_ONCE void begin_elsewhere(Search& search, bool guided, std::vector<EvaluatedHypothesis>& children) {
  constexpr double far = 100;  // times the loss: no error of an integrator that follows the motion
  Search own = search;
  seek_elsewhere(own, guided, children);
  if (children.empty()) return;
  const Hypothesis& best = children[best_of(children, search.problem.criteria)].hypothesis;
  own.problem.fit.weighting = search.problem.fit.weighting;
  const double as_fitted = loss_of(search.bound, best, own.problem.fit, search.parallel);
  if (loss_of(search.bound, best, search.problem.fit, search.parallel) < far * as_fitted) return;
  search.problem.fit.integration = own.problem.fit.integration;
  search.problem.screening = own.problem.screening;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> first_effects(Search& search, const EvaluatedHypothesis& none) {
  const SelectionCriteria& criteria = search.problem.criteria;
  std::vector<EvaluatedHypothesis> children;
  const bool structured = leaves_structure(search, none), guided = structured && has_lost_readings(none);
  if (guided) {
    children = extended_under_guidance(search);
    if (settle_alone(search, children)) return children;
  }
  std::vector<EvaluatedHypothesis> others;
  if (!search.problem.stopped()) extend(search, none, none, others);
  for (const EvaluatedHypothesis& one : others) keep_best_form(children, one, criteria);
  std::vector<EvaluatedHypothesis> compared = children;
  compared.push_back(none);
  if (structured && !yields(search, compared)) begin_elsewhere(search, guided, children);
  return children;
}

}  // namespace surefoot::diagnosis
