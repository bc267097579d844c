// Definitions of surefoot/diagnose/selection/extend.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
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
#include "surefoot/diagnose/estimation/trimmed_fit.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
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

/// What simulations leave of each output, or what an error of the integration may be.
SUREFOOT_ONCE Eigen::VectorXd sizes_of_errors(const Search& search, const std::vector<SimulatedRun>& runs) {
  Eigen::VectorXd sizes = residual_sizes(search.bound, search.problem.fit.recordings, runs);
  for (Eigen::Index k = 0; k < sizes.size(); ++k) {
    sizes[k] = std::max(sizes[k], search.problem.criteria.least_error * search.problem.scale.sigma[k]);
  }
  return sizes;
}

SUREFOOT_ONCE void reweight(Search& search, const EvaluatedHypothesis& best) {
  FitProblem& problem = search.problem.fit;
  const auto runs =
      simulate_all(search.bound, best.hypothesis, problem.recordings, problem.integration, search.parallel);
  problem.weighting.sigma = sizes_of_errors(search, runs);
  problem.weighting.scale = recording_scales(search.bound, problem, runs);
  search.problem.screened = some_by_error(search.bound, problem.recordings, runs, search.problem.screened.size());
}

SUREFOOT_ONCE bool refine_integration(Search& search, const EvaluatedHypothesis& best) {
  FitProblem& problem = search.problem.fit;
  const auto [fitting, screening] = choose_integrations(search.bound, best.hypothesis, problem.weighting.sigma,
                                                        problem.integration, problem.recordings, search.parallel);
  const bool finer = is_finer(fitting, problem.integration);
  if (finer) problem.integration = fitting;
  search.problem.screening = screening;
  return finer;
}

SUREFOOT_ONCE void choose_screening(Search& search, const EvaluatedHypothesis& parent) {
  const FitProblem& problem = search.problem.fit;
  const auto runs =
      simulate_all(search.bound, parent.hypothesis, problem.recordings, problem.integration, search.parallel);
  search.problem.screening = choose_integrations(search.bound, parent.hypothesis, sizes_of_errors(search, runs),
                                                 problem.integration, problem.recordings, search.parallel)
                                 .screening;
}

SUREFOOT_ONCE EvaluatedHypothesis refitted(const Search& search, const Hypothesis& one) {
  return evaluate_fit(search.bound, fit(search.bound, one, search.problem.fit, serially()), search.problem, serially());
}

SUREFOOT_ONCE void enrich(const Search& search, std::vector<EvaluatedHypothesis>& pool, double hopeless,
                          ErrorsOfForm errors_of_form, double reach) {
  const auto& [bound, problem, candidates, parallel] = search;
  for (const EvaluatedHypothesis& one : best_structures(pool, problem.effort.finalists, hopeless, problem.criteria)) {
    if (problem.stopped()) return;
    const auto richer = in_richer_forms(search, one, errors_of_form, reach);
    if (richer) keep_best_form(pool, *richer, problem.criteria);
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
  const bool beatable = !pool.empty() && leaves_structure(search, pool[best_of(pool, problem.criteria)]);
  if (!beatable) return;
  const FitProblem quick = screening_fit(problem, problem.effort.restart_iterations);
  for (const EvaluatedHypothesis& one :
       best_structures(pool, problem.effort.restarted, none_is_hopeless, problem.criteria)) {
    const bool calibrated = search.effects(one) == 0;  // from many places, before the search
    if (problem.stopped() || calibrated || explains(search, one)) continue;
    const Fit fitted = fit(search.bound, one.hypothesis, problem.fit, search.parallel);  // with the present weights
    Fit again =
        restarted_fit(search.bound, fitted, problem.fit, quick, problem.effort.restarts, restart_seed, search.parallel);
    again = grown_fit(search.bound, again, again.hypothesis, problem.fit, search.parallel);
    again = guided_fit(search.bound, again, again.hypothesis, problem.fit, search.parallel);
    again = trimmed_fit(search.bound, again, problem.fit, search.parallel);
    if (!(again.loss < fitted.loss)) continue;
    keep_best_form(pool, evaluate_fit(search.bound, again, problem, search.parallel), problem.criteria);
  }
}

/// A fit with the way inputs go between rows and the steps that it needs, which may have been chosen for worse ones.
SUREFOOT_ONCE EvaluatedHypothesis with_integration_of_its_own(Search& search, const EvaluatedHypothesis& one) {
  Fit fitted{one.hypothesis, one.loss, true};
  const bool holds = choose_holds(search.bound, fitted, search.problem, search.parallel);
  const bool finer = refine_integration(search, one);
  return holds || finer ? refitted(search, fitted.hypothesis) : one;
}

SUREFOOT_ONCE bool settle_alone(Search& search, std::vector<EvaluatedHypothesis>& children) {
  const SelectionCriteria& criteria = search.problem.criteria;
  if (children.empty() || search.problem.stopped()) return false;
  EvaluatedHypothesis best = children[best_of(children, criteria)];
  if (search.effects(best) != 1) return false;
  Search own = search;
  reweight(own, best);
  best = with_integration_of_its_own(own, best);
  if (!explains(own, best)) {
    std::vector<EvaluatedHypothesis> forms =
        in_other_forms(own, best, own.problem.known, own.problem.effort.compared_finalists, false);
    forms.push_back(best);
    enrich(own, forms, none_is_hopeless, ErrorsOfForm::tolerated, loss_at_noise(best, own.problem));
    best = with_integration_of_its_own(own, forms[best_of(forms, criteria)]);
    if (!explains(own, best)) return false;
  }
  search.problem = own.problem;
  children = fitted_again(search, children);
  keep_best_form(children, best, criteria);
  return true;
}

SUREFOOT_ONCE void fit_from_everywhere(const Search& search, std::vector<EvaluatedHypothesis>& children) {
  constexpr std::uint64_t scatter_seed = 1;
  const SearchProblem& problem = search.problem;
  search.parallel(children.size(), [&](std::size_t i) {
    EvaluatedHypothesis& one = children[i];
    if (problem.stopped() || search.effects(one) != 1) return;
    const Fit fitted{one.hypothesis, one.loss, true};
    const Fit elsewhere = scattered_fit(search.bound, fitted, fitted.hypothesis, problem.fit,
                                        problem.effort.scattered_points, scatter_seed, serially());
    if (elsewhere.loss < one.loss) one = evaluate_fit(search.bound, elsewhere, problem, serially());
  });
}

SUREFOOT_ONCE void extend(Search& search, const EvaluatedHypothesis& parent, const EvaluatedHypothesis& best,
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
  if (!structured || leaves_only_noise(parent, problem) || !room || enough || problem.stopped()) return;
  if (first) {
    if (settle_alone(search, children)) return;
    if (problem.scatter) fit_from_everywhere(search, children);
    if (!children.empty() && explains(search, children[best_of(children, problem.criteria)])) return;
    for (const EvaluatedHypothesis& child : next_tied_pairs(search, parent, proposals, effort.pairs)) {
      keep_best_form(children, child, problem.criteria);
    }
  }
  const double needed = first ? 0 : needed_gain(search, parent, best, 2);
  for (const EvaluatedHypothesis& child : next_pairs(search, parent, proposals, needed)) {
    keep_best_form(children, child, problem.criteria);
  }
}

}  // namespace surefoot::diagnosis
