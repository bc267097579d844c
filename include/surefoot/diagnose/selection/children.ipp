// Definitions of surefoot/diagnose/selection/children.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/pairs.hpp"
#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE EvaluatedHypothesis Search::without(const EvaluatedHypothesis& whole, std::size_t effect) const {
  const Fit rest = fit(bound, without_effect(whole.hypothesis, effect), problem.fit, parallel);
  return evaluate_fit(bound, rest, problem, parallel);
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

SUREFOOT_ONCE EvaluatedHypothesis inside_bounds(const Search& search, const EvaluatedHypothesis& one, double odds) {
  const SelectionCriteria& criteria = search.problem.criteria;
  if (odds > 0 || odds + criteria.bound_cost < 0) return one;
  const auto inside = drawn_inside(search, one.hypothesis);
  if (!inside) return one;
  const Fit fitted = fit(search.bound, *inside, search.problem.fit, serially());
  const EvaluatedHypothesis again = evaluate_fit(search.bound, fitted, search.problem, serially());
  return log_odds_of_forms(again, one, criteria) > 0 ? again : one;
}

/// A parent with some effects more, beginning at these parameters.
SUREFOOT_ONCE Hypothesis with_effects(Hypothesis parent, const std::vector<Proposal>& additions,
                                      const std::vector<Eigen::VectorXd>& starts) {
  for (std::size_t k = 0; k < starts.size(); ++k) {
    std::size_t before = additions[k].before;  // where the parent has it
    for (std::size_t j = 0; j < k; ++j) before += additions[j].before <= additions[k].before ? 1 : 0;
    parent = with_effect(std::move(parent), additions[k].effect, starts[k], before);
  }
  return parent;
}

/// What can grow from nothing: from what the signatures promise, and weaker where that was too bold.
SUREFOOT_ONCE Fit fit_grown(const BoundSimulator& bound, const Hypothesis& parent,
                            const std::vector<Proposal>& additions, const FitProblem& quick, double parent_loss,
                            const SearchEffort& effort) {
  std::vector<Eigen::VectorXd> predicted, weak;
  double promised = 1 - effort.bold_loss;  // much of it is enough, or half of what the signatures say
  for (const Proposal& addition : additions) {
    predicted.push_back(addition.start);
    weak.push_back(addition.start);
    for (const Eigen::Index k : strengths_of(*addition.effect.effect)) weak.back()[k] *= effort.weak_start;
    promised = std::min(promised, std::max(0.0, addition.gain) / 2);
  }
  const Fit bold = fit(bound, with_effects(parent, additions, predicted), quick, serially());
  if (bold.ok && bold.loss < (1 - promised) * parent_loss) return bold;
  const Fit timid = fit(bound, with_effects(parent, additions, weak), quick, serially());
  return timid.ok && (!bold.ok || timid.loss < bold.loss) ? timid : bold;
}

/// What cannot grow from nothing begins with everything else settled around it: where that leaves least is the best
/// place to go on, and what leaves more than the parent is in another valley.
SUREFOOT_ONCE Fit fit_settled(const BoundSimulator& bound, const Hypothesis& parent,
                              const std::vector<Proposal>& additions, const FitProblem& quick, double parent_loss,
                              const SearchEffort& effort) {
  FitProblem around = quick;
  around.free = Free::all_but_effects;
  std::vector<Eigen::VectorXd> predicted;
  for (const Proposal& addition : additions) predicted.push_back(addition.start);
  std::vector<Fit> settled{fit(bound, with_effects(parent, additions, predicted), around, serially())};
  if (additions.size() == 1) {
    const auto& others = additions.front().more_starts;
    for (std::size_t k = 0; k < std::min(effort.more_starts, others.size()); ++k) {
      settled.push_back(fit(bound, with_effects(parent, additions, {others[k]}), around, serially()));
    }
  }
  drop_items(settled, [](const Fit& one) { return !one.ok; });
  sort_items(settled, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  Fit best;
  for (const Fit& start : settled) {
    if (best.ok && (!(start.loss < parent_loss) || best.loss < effort.bold_loss * parent_loss)) break;
    const Fit one = fit(bound, start.hypothesis, quick, serially());
    if (one.ok && one.loss < best.loss) best = one;
  }
  return best;
}

SUREFOOT_ONCE Fit fit_child(const BoundSimulator& bound, const Hypothesis& parent,
                            const std::vector<Proposal>& additions, const SearchProblem& problem) {
  const FitProblem quick = screening_fit(problem, problem.effort.first_iterations);
  const double parent_loss = loss_of(bound, parent, quick, serially());
  const bool grows = holds_for_any(additions, [](const Proposal& one) {
    return holds_for_any(strengths_of(*one.effect.effect), [&](Eigen::Index k) { return one.start[k] != 0; });
  });
  const auto fitted = grows ? fit_grown : fit_settled;
  return fitted(bound, parent, additions, quick, parent_loss, problem.effort);
}

/// Effects that a parent has not yet, best first.
SUREFOOT_ONCE std::vector<Proposal> proposals_for(const Search& search, const EvaluatedHypothesis& parent) {
  const auto& [bound, problem, candidates, parallel] = search;
  const FitProblem screened = screening_fit(problem, 0);
  std::vector<AttachedEffect> open;
  for (const AttachedEffect& candidate : candidates) {
    const bool used = holds_for_any(parent.hypothesis.effects,
                                    [&](const AttachedEffect& effect) { return same_but_for_form(effect, candidate); });
    if (!used) open.push_back(candidate);
  }
  std::vector<Proposal> proposals = propose(bound, parent.hypothesis, screened, open, problem.known, parallel);
  drop_items(proposals, [&](const Proposal& one) {
    return one.distinct < problem.criteria.least_distinct && !(one.gain > problem.criteria.structure_share);
  });
  return proposals;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> finished(const Search& search, std::vector<Fit> fits, std::size_t keep) {
  const auto& [bound, problem, candidates, parallel] = search;
  drop_items(fits, [](const Fit& one) { return !one.ok; });
  const auto keep_best = [&](std::size_t count) {
    sort_items(fits, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
    if (fits.size() > count) fits.resize(count);
  };
  if (fits.size() > problem.effort.second_look * keep) {
    keep_best(problem.effort.second_look * keep);
    const FitProblem quick = screening_fit(problem, problem.effort.second_iterations);
    fit_each(bound, fits, quick, parallel);
  }
  keep_best(keep);
  fit_each(bound, fits, problem.fit, parallel);
  std::vector<EvaluatedHypothesis> evaluated(fits.size());
  parallel(fits.size(), [&](std::size_t i) {
    if (!problem.stopped()) evaluated[i] = evaluate_fit(bound, fits[i], problem, serially());
  });
  drop_items(evaluated, [](const EvaluatedHypothesis& one) { return one.errors.empty(); });
  return evaluated;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> finished_from(const Search& search, std::vector<Fit> starts,
                                                             std::size_t keep) {
  const SearchProblem& problem = search.problem;
  const FitProblem quick = screening_fit(problem, problem.effort.first_iterations);
  fit_each(search.bound, starts, quick, search.parallel);
  return finished(search, std::move(starts), keep);
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> evaluate_children(const Search& search,
                                                                 const EvaluatedHypothesis& parent,
                                                                 const std::vector<std::vector<Proposal>>& additions,
                                                                 std::size_t keep) {
  const SearchProblem& problem = search.problem;
  std::vector<Fit> fits(additions.size());
  search.parallel(additions.size(), [&](std::size_t i) {
    if (!problem.stopped()) fits[i] = fit_child(search.bound, parent.hypothesis, additions[i], problem);
  });
  return finished(search, std::move(fits), keep);
}

/// The parent with one effect more. A signature that does not help as it is may do so once everything is fitted: such
/// proposals fill what room is left.
SUREFOOT_ONCE std::vector<EvaluatedHypothesis> next_effects(const Search& search, const EvaluatedHypothesis& parent,
                                                            std::vector<Proposal> proposals, std::size_t shortlist,
                                                            std::size_t finalists) {
  if (proposals.size() > shortlist) proposals.resize(shortlist);
  std::vector<std::vector<Proposal>> singles;
  for (Proposal& one : proposals) {
    if (!(one.gain > 0)) one.start = one.tried;
    singles.push_back({std::move(one)});
  }
  return evaluate_children(search, parent, singles, finalists);
}

SUREFOOT_ONCE double gain_for(double odds, const ErrorSquares& errors) {
  double independent = 1;
  for (Eigen::Index k = 0; k < errors.counts.cols(); ++k) {
    for (Eigen::Index r = 0; r < errors.counts.rows(); ++r) independent += errors.counts(r, k) / errors.memory[k];
  }
  return 1 - std::exp(-2 * odds / independent);
}

SUREFOOT_ONCE double needed_gain(const Search& search, const EvaluatedHypothesis& parent,
                                 const EvaluatedHypothesis& best, std::size_t effects) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const double each = std::log(static_cast<double>(std::max<std::size_t>(2, search.problem.candidates)));
  const double cost = static_cast<double>(effects) * (each + criteria.form_cost);
  const double behind = std::max(0.0, log_odds(best, parent, criteria)) - std::log(criteria.tie_odds);
  return gain_for(std::max(0.0, cost + behind), best.errors);
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> evaluate_pairs(const Search& search, const EvaluatedHypothesis& parent,
                                                              std::vector<ProposedPair> proposed) {
  std::vector<std::vector<Proposal>> pairs;
  for (ProposedPair& pair : proposed) {
    pairs.push_back({std::move(pair.first), std::move(pair.second)});
  }
  return evaluate_children(search, parent, pairs, search.problem.effort.pair_finalists);
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> next_pairs(const Search& search, const EvaluatedHypothesis& parent,
                                                          const std::vector<Proposal>& proposals, double needed) {
  const SearchEffort& effort = search.problem.effort;
  std::vector<ProposedPair> proposed = propose_pairs(proposals, effort.pairs);
  drop_what_cannot_pay(proposed, needed, effort);
  return evaluate_pairs(search, parent, std::move(proposed));
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> next_tied_pairs(const Search& search, const EvaluatedHypothesis& parent,
                                                               const std::vector<Proposal>& proposals,
                                                               std::size_t most) {
  return evaluate_pairs(search, parent, propose_tied_pairs(proposals, most));
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> best_structures(std::vector<EvaluatedHypothesis> pool, std::size_t count,
                                                               double hopeless, const SelectionCriteria& criteria) {
  std::vector<EvaluatedHypothesis> best;
  while (best.size() < count && !pool.empty()) {
    const std::size_t next = best_of(pool, criteria);
    if (!best.empty() && log_odds(pool[next], best.front(), criteria) < -hopeless) break;
    best.push_back(pool[next]);
    pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(next));
  }
  return best;
}

/// Both effects of two hypotheses with the parameters of the first, each at half of its strength.
SUREFOOT_ONCE Hypothesis half_of_each(const Hypothesis& a, const Hypothesis& b, std::size_t known) {
  constexpr double half = 0.5;  // as if they shared what each explains alone
  Hypothesis both = a;
  both.effects.push_back(b.effects[known]);
  both.values.push_back(b.values[known]);
  for (std::size_t e = known; e < both.effects.size(); ++e) {
    for (const Eigen::Index k : strengths_of(*both.effects[e].effect)) both.values[e][k] *= half;
  }
  return both;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> combined(const Search& search,
                                                        const std::vector<EvaluatedHypothesis>& singles) {
  const SearchProblem& problem = search.problem;
  std::vector<EvaluatedHypothesis> best = singles;
  drop_items(best, [&](const EvaluatedHypothesis& one) { return search.effects(one) != 1; });
  best = best_structures(best, problem.effort.combined, none_is_hopeless, problem.criteria);
  std::vector<Fit> fits;
  for (std::size_t i = 0; i < best.size(); ++i) {
    for (std::size_t j = i + 1; j < best.size(); ++j) {
      fits.push_back({half_of_each(best[i].hypothesis, best[j].hypothesis, problem.known)});
    }
  }
  return finished_from(search, std::move(fits), problem.effort.pair_finalists);
}

}  // namespace surefoot::diagnosis
