// Definitions of surefoot/diagnose/selection/rivals.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
#include "surefoot/diagnose/selection/first_effects.hpp"
#include "surefoot/diagnose/selection/richer_forms.hpp"
#include "surefoot/diagnose/selection/rivals.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double needed_instead(const Search& search, const EvaluatedHypothesis& rest,
                                    const EvaluatedHypothesis& best, std::size_t effect,
                                    const std::vector<Proposal>& proposals) {
  double promised = 0;
  for (const Proposal& one : proposals) {
    if (same_but_for_form(one.effect, best.hypothesis.effects[effect])) promised = std::max(promised, one.gain);
  }
  return std::min(promised, needed_gain(search, rest, best, 1));
}

SUREFOOT_ONCE void swap_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool,
                                std::vector<Hypothesis>& done) {
  constexpr double progress = 0.8;  // of the search
  const SearchProblem& problem = search.problem;
  const EvaluatedHypothesis best = pool[best_of(pool, problem.criteria)];
  for (std::size_t e = problem.known; e < best.hypothesis.effects.size() && !problem.stopped(); ++e) {
    problem.on_progress("comparing alternatives", progress);
    const EvaluatedHypothesis rest = search.without(best, e);
    keep_best_form(pool, rest, problem.criteria);
    const bool extended = search.effects(best) == 1 || is_among(rest.hypothesis, done);
    if (extended) continue;  // before; from no effects at all, when the first one was chosen
    done.push_back(rest.hypothesis);
    Search coarse = search;
    choose_screening(coarse, rest);
    std::vector<Proposal> proposals = proposals_for(coarse, rest);
    drop_what_cannot_pay(proposals, needed_instead(search, rest, best, e, proposals), problem.effort);
    const std::string& name = best.hypothesis.effects[e].effect->name;  // the right name may be at a wrong place
    put_first(proposals, [&](const Proposal& one) { return one.effect.effect->name == name; });
    for (const EvaluatedHypothesis& other :
         next_effects(coarse, rest, std::move(proposals),
                      std::min(problem.effort.compared_shortlist, problem.effort.further_shortlist),
                      problem.effort.compared_finalists)) {
      keep_best_form(pool, other, problem.criteria);
    }
  }
}

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
      drop_items(proposals, [&](const Proposal& one) {
        const bool signal = one.effect.at >= static_cast<int>(search.bound.info.inputs.size());
        return !acts_on_input(one.effect) || signal ||
               (!is_like(*one.effect.effect, *effects[e].effect) && !is_like(*one.effect.effect, *effects[f].effect));
      });
      // few are left out by their gains: what has no strength promises nothing before all else is settled
      for (const EvaluatedHypothesis& other :
           next_tied_pairs(search, parent, proposals, problem.effort.max_shortlist)) {
        keep_best_form(pool, other, problem.criteria);
      }
    }
  }
}

SUREFOOT_ONCE void weigh_with_its_own_steps(Search& search, const EvaluatedHypothesis& rival,
                                            const EvaluatedHypothesis& best, std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  Search fine = search;
  if (search.problem.stopped() || !refine_integration(fine, rival)) return;
  const EvaluatedHypothesis again = refitted(fine, rival.hypothesis);
  const auto better_than = [&](const EvaluatedHypothesis& one) {
    const bool form = same_structure(again.hypothesis, one.hypothesis);
    return (form ? log_odds_of_forms(again, one, criteria) : log_odds(again, one, criteria)) > 0;
  };
  const Fit as_found{best.hypothesis, best.loss, true};  // which a fit makes no worse
  if (!better_than(evaluate_fit(fine.bound, as_found, fine.problem, fine.parallel))) return;
  if (!better_than(refitted(fine, best.hypothesis))) return;
  search.problem.fit.integration = fine.problem.fit.integration;
  search.problem.screening = fine.problem.screening;
  pool = fitted_again(search, pool);
  keep_best_form(pool, again, criteria);
}

/// Richer forms of rivals of the best structure; where one is hopelessly far behind that, of those that begin to come
/// nearer to it.
SUREFOOT_ONCE void enrich_rivals(const Search& search, const EvaluatedHypothesis& best,
                                 std::vector<EvaluatedHypothesis>& rivals) {
  constexpr double any_loss = std::numeric_limits<double>::infinity();
  const SearchProblem& problem = search.problem;
  for (const EvaluatedHypothesis& one :
       best_structures(rivals, problem.effort.finalists, none_is_hopeless, problem.criteria)) {
    if (problem.stopped()) return;
    const bool far = log_odds(one, best, problem.criteria) < -problem.effort.hopeless;
    if (far && problem.fit.reach > 0) continue;  // the best structure cannot be beaten
    const auto richer = in_richer_forms(search, one, ErrorsOfForm::tolerated, far ? best.loss : any_loss);
    if (richer) keep_best_form(rivals, *richer, problem.criteria);
  }
}

/// The other forms of an effect of the best structure.
SUREFOOT_ONCE void try_other_forms(Search& search, const EvaluatedHypothesis& best, std::size_t e,
                                   std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  const bool structured = leaves_structure(search, best);
  const bool finely = structured && !leaves_only_noise(best, problem);
  std::vector<EvaluatedHypothesis> others = in_other_forms(search, best, e, problem.effort.compared_finalists, finely);
  enrich_rivals(search, best, others);
  for (const EvaluatedHypothesis& one : others) {
    keep_best_form(pool, one, problem.criteria);
    if (structured) weigh_with_its_own_steps(search, one, best, pool);
  }
}

/// Leaves out what cannot explain `needed`, but for effects without a strength: their signatures say little.
SUREFOOT_ONCE void drop_growing_that_cannot_pay(std::vector<Proposal>& proposals, double needed,
                                                const SearchEffort& effort) {
  drop_items(proposals, [&](const Proposal& one) {
    return !strengths_of(*one.effect.effect).empty() && one.gain * effort.underestimated < needed;
  });
}

/// Whether one of these is this effect, in any form.
SUREFOOT_ONCE bool has_in_any_form(const std::vector<AttachedEffect>& effects, const AttachedEffect& one) {
  return holds_for_any(effects, [&](const AttachedEffect& other) { return same_but_for_form(other, one); });
}

/// A fit of what stands in an effect's place, if it promises as much as that effect, but is fitted neither as well nor
/// to what it promises: without it, and with a first guess in its place, readings may be lost, so that this is a fit
/// under their guidance. No further where it is worse than the best structure so, too. Only what leaves no more than
/// noise counts, as in extend_from_nominal.
SUREFOOT_ONCE void guide_what_promises(const Search& search, const EvaluatedHypothesis& rest,
                                       const EvaluatedHypothesis& best, const Proposal& one, double needed,
                                       std::vector<EvaluatedHypothesis>& fitted) {
  constexpr double as_much = 0.9;  // of what is needed
  constexpr double as_well = 2;    // times the loss of the best structure
  constexpr double kept = 0.5;     // of the promised gain: a fit that was not lost
  const FitProblem& problem = search.problem.fit;
  if (search.problem.stopped() || one.gain < as_much * needed || !can_be_guided(search.bound, problem)) return;
  for (const EvaluatedHypothesis& other : fitted) {
    if (!has_in_any_form(other.hypothesis.effects, one.effect)) continue;
    const double left = other.errors.rms() / rest.errors.rms();
    if (other.loss < as_well * best.loss || 1 - left * left > kept * one.gain) return;
  }
  const std::span<const double> horizons = guided_horizons;
  FitProblem near = problem;
  near.integration.follow = guided_follow(search.bound, problem, horizons.front());
  Hypothesis reached = with_effect(rest.hypothesis, one.effect, one.start, one.before);
  reached = guided(search.bound, reached, problem, horizons.first(1), search.parallel);
  const double at_best = loss_of(search.bound, best.hypothesis, near, search.parallel);
  if (!(loss_of(search.bound, reached, near, search.parallel) < as_well * at_best)) return;
  reached = guided(search.bound, reached, problem, horizons.subspan(1), search.parallel);
  EvaluatedHypothesis child = refitted(search, reached);
  if (explains(search, child)) fitted.push_back(std::move(child));
}

/// Other effects that an effect of the best structure may be confused with, and the same elsewhere.
SUREFOOT_ONCE void try_in_its_place(Search& search, const EvaluatedHypothesis& best, std::size_t e,
                                    std::vector<EvaluatedHypothesis>& pool) {
  const AttachedEffect& found = best.hypothesis.effects[e];
  std::vector<AttachedEffect> others, elsewhere;  // each get their own finalists: forms would crowd the others out
  for (const AttachedEffect& one : search.candidates) {
    if (may_be_confused(*one.effect, *found.effect)) others.push_back(one);
    if (one.effect->name == found.effect->name && !same_but_for_form(one, found)) elsewhere.push_back(one);
  }
  const Fit without{without_effect(best.hypothesis, e), 0, true};
  for (const std::vector<AttachedEffect>& rivals : {others, elsewhere}) {
    if (search.problem.stopped()) return;
    const SearchProblem problem = search.problem;  // in the steps that the rivals before may have needed
    const EvaluatedHypothesis rest = evaluate_fit(search.bound, without, problem, search.parallel);
    std::vector<AttachedEffect> measured = rivals;  // by what the effect itself promises
    for (const AttachedEffect& one : search.candidates) {
      if (same_but_for_form(one, found)) measured.push_back(one);
    }
    Search among{search.bound, problem, measured, search.parallel};
    choose_screening(among, rest);
    std::vector<Proposal> proposals = proposals_for(among, rest);
    const double needed = needed_instead(search, rest, best, e, proposals);
    drop_items(proposals, [&](const Proposal& one) { return same_but_for_form(one.effect, found); });
    drop_growing_that_cannot_pay(proposals, needed, problem.effort);
    std::vector<EvaluatedHypothesis> fitted =
        next_effects(among, rest, proposals, rivals.size(), problem.effort.compared_finalists);
    for (const Proposal& one : proposals) guide_what_promises(among, rest, best, one, needed, fitted);
    enrich_rivals(search, best, fitted);
    for (const EvaluatedHypothesis& one : fitted) {
      keep_best_form(pool, one, problem.criteria);
      weigh_with_its_own_steps(search, one, best, pool);
    }
  }
}

/// Each effect of the best structure taken away, and another in its other forms and in richer ones: the one may only
/// mend the form of the other.
SUREFOOT_ONCE void try_other_forms_without(const Search& search, const EvaluatedHypothesis& best,
                                           std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  for (std::size_t e = problem.known; e < best.hypothesis.effects.size(); ++e) {
    EvaluatedHypothesis rest = best;
    rest.hypothesis = without_effect(best.hypothesis, e);
    for (std::size_t f = problem.known; f < rest.hypothesis.effects.size() && !problem.stopped(); ++f) {
      std::vector<EvaluatedHypothesis> others = in_other_forms(search, rest, f, 1, false);
      enrich_rivals(search, best, others);
      for (const EvaluatedHypothesis& one : others) keep_best_form(pool, one, problem.criteria);
    }
    if (problem.stopped() || search.effects(best) < 2 || !may_mend_form(best.hypothesis, rest.hypothesis)) continue;
    const auto richer = in_richer_forms(search, search.without(best, e), ErrorsOfForm::counted, best.loss);
    if (richer) keep_best_form(pool, *richer, problem.criteria);
  }
}

SUREFOOT_ONCE void try_confusable(Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const EvaluatedHypothesis chosen = pool[best_of(pool, search.problem.criteria)];
  for (std::size_t e = search.problem.known; e < chosen.hypothesis.effects.size() && !search.problem.stopped(); ++e) {
    try_other_forms(search, chosen, e, pool);
  }
  try_other_forms_without(search, chosen, pool);
  const EvaluatedHypothesis best = pool[best_of(pool, search.problem.criteria)];
  for (std::size_t e = search.problem.known; e < best.hypothesis.effects.size(); ++e) {
    try_in_its_place(search, best, e, pool);
  }
}

/// An effect with the parameters that it was found with.
struct ReadyEffect {
  AttachedEffect effect;
  Eigen::VectorXd values;
};

/// A structure with another effect in the place of number `e`.
SUREFOOT_ONCE Fit exchanged(const Hypothesis& structure, std::size_t e, const ReadyEffect& other) {
  Fit result{structure};
  result.hypothesis.effects[e] = other.effect;
  result.hypothesis.values[e] = other.values;
  return result;
}

/// Effects of the best structures that the first of these has not, in any form.
SUREFOOT_ONCE std::vector<ReadyEffect> effects_of_others(const Search& search,
                                                         const std::vector<EvaluatedHypothesis>& best) {
  std::vector<AttachedEffect> there = best.front().hypothesis.effects;
  std::vector<ReadyEffect> others;
  for (const EvaluatedHypothesis& one : best) {
    for (std::size_t e = search.problem.known; e < one.hypothesis.effects.size(); ++e) {
      const AttachedEffect& effect = one.hypothesis.effects[e];
      if (has_in_any_form(there, effect)) continue;
      there.push_back(effect);
      others.push_back({effect, one.hypothesis.values[e]});
    }
  }
  return others;
}

/// A structure with what one of its effects comes to without some of its parameters in the place of that one.
SUREFOOT_ONCE std::vector<Fit> with_special_cases(const Search& search, const Hypothesis& structure) {
  std::vector<Fit> fits;
  for (std::size_t e = search.problem.known; e < structure.effects.size(); ++e) {
    for (const AttachedEffect& one : search.candidates) {
      const Eigen::VectorXd values = values_of_special_case(one, structure.effects[e], structure.values[e]);
      if (values.size() == 0 || has_in_any_form(structure.effects, one)) continue;
      const std::size_t recordings = search.bound.recordings.size();
      fits.push_back(exchanged(structure, e, {one, values_before_starts(*one.effect, values, recordings)}));
    }
  }
  return fits;
}

SUREFOOT_ONCE void exchange_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  const std::vector<EvaluatedHypothesis> best =
      best_structures(pool, problem.effort.predicted, none_is_hopeless, problem.criteria);
  const Hypothesis& first = best.front().hypothesis;
  std::vector<Fit> special = with_special_cases(search, first), of_others;
  if (search.effects(best.front()) > 1) {  // single effects were all tried
    for (const ReadyEffect& other : effects_of_others(search, best)) {
      for (std::size_t e = problem.known; e < first.effects.size(); ++e)
        of_others.push_back(exchanged(first, e, other));
    }
  }
  for (std::vector<Fit>* fits : {&special, &of_others}) {  // each get their own finalists
    for (const EvaluatedHypothesis& one : finished_from(search, std::move(*fits), problem.effort.compared_finalists)) {
      keep_best_form(pool, one, problem.criteria);
    }
  }
}

/// Whether a parameter of the model, which its user bounds, was driven to a bound.
SUREFOOT_ONCE bool drives_parameters_to_bounds(const Search& search, const Hypothesis& one) {
  for (const Variable& variable : variables_of(search.bound, one, {}, Free::all_but_effects)) {
    const bool of_model = variable.kind == Variable::Kind::parameter;
    if (of_model && is_at_bound(one, variable, search.problem.criteria)) return true;
  }
  return false;
}

SUREFOOT_ONCE void extend_from_nominal(Search search, std::vector<EvaluatedHypothesis>& pool) {
  const EvaluatedHypothesis best = pool[best_of(pool, search.problem.criteria)];
  if (search.problem.stopped() || search.effects(best) == 0 || explains(search, best)) return;
  if (!drives_parameters_to_bounds(search, best.hypothesis)) return;
  Hypothesis start = best.hypothesis;
  start.parameters = search.problem.nominal.parameters;
  start.initial = search.problem.nominal.initial;
  const EvaluatedHypothesis parent = evaluate_fit(search.bound, Fit{start, 0, true}, search.problem, search.parallel);
  reweight(search, parent);
  std::vector<EvaluatedHypothesis> children;
  extend(search, parent, best, children);
  for (const EvaluatedHypothesis& child : children) {
    if (explains(search, child)) keep_best_form(pool, child, search.problem.criteria);
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

}  // namespace surefoot::diagnosis
