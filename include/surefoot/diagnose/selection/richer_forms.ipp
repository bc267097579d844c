// Definitions of surefoot/diagnose/selection/richer_forms.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/estimation/starting_values.hpp"
#include "surefoot/diagnose/selection/explains.hpp"
#include "surefoot/diagnose/selection/richer_forms.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE bool extends(const AttachedEffect& richer, const AttachedEffect& one) {
  const auto& forms = richer.effect->extends;
  return same_but_for_form(richer, one) && richer.other == one.other &&
         std::find(forms.begin(), forms.end(), one.effect->form) != forms.end();
}

/// The value of a parameter of this name; none if the effect has no such.
SUREFOOT_ONCE std::optional<double> value_named(const std::string& name, const Effect& effect,
                                                const Eigen::VectorXd& values) {
  for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
    if (effect.parameters[k].name == name) return values[static_cast<Eigen::Index>(k)];
  }
  return std::nullopt;
}

SUREFOOT_ONCE Eigen::VectorXd values_of_special_case(const AttachedEffect& special, const AttachedEffect& whole,
                                                     const Eigen::VectorXd& values) {
  const bool there = special.effect->place == whole.effect->place && special.at == whole.at;
  if (!there || special.other != whole.other || !may_be_confused(*special.effect, *whole.effect)) return {};
  const auto& parameters = special.effect->parameters;
  Eigen::VectorXd result(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto value = value_named(parameters[k].name, *whole.effect, values);
    if (!value) return {};
    result[static_cast<Eigen::Index>(k)] = *value;
  }
  return result;
}

/// The same with one effect in another form, once for each of the starts of its further parameters, times a factor; a
/// form that only readings suggest begins as the one that was found.
SUREFOOT_ONCE std::vector<Hypothesis> starts_in_form(const Search& search, const Hypothesis& found, std::size_t e,
                                                     const AttachedEffect& form, double factor = 1) {
  const std::size_t recordings = search.bound.recordings.size();
  std::vector<Hypothesis> starts;
  std::vector<std::vector<double>> tried;
  std::vector<Eigen::VectorXd> all = starting_values(search.bound, form, {});
  const auto parameters = static_cast<Eigen::Index>(form.effect->parameters.size());
  if (all.empty()) all.push_back(Eigen::VectorXd::Zero(parameters));
  for (Eigen::VectorXd& values : all) {
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      const std::string& name = form.effect->parameters[static_cast<std::size_t>(k)].name;
      values[k] = value_named(name, *found.effects[e].effect, found.values[e]).value_or(factor * values[k]);
    }
    const std::vector<double> start(values.begin(), values.end());
    if (std::find(tried.begin(), tried.end(), start) != tried.end()) continue;  // starts of the known ones do not count
    tried.push_back(start);
    Hypothesis one = found;
    one.effects[e] = form;
    one.values[e] = values_before_starts(*form.effect, values, recordings);
    starts.push_back(std::move(one));
  }
  return starts;
}

/// Whether a richer form adds something that moves by itself, with a strength of its own, and does not only bend.
SUREFOOT_ONCE bool adds_motion(const Effect& richer, const Effect& special) {
  return richer.hidden_states > special.hidden_states && strengths_of(richer).size() > strengths_of(special).size();
}

/// The start in a richer form that comes nearest to its special case. Where the form adds what moves by itself, starts
/// say little as they are, since everything else was fitted to make up for it: the one that leaves least under the
/// guidance of the readings, as reached so (guided_fit.hpp).
SUREFOOT_ONCE Hypothesis with_form(const Search& search, const Hypothesis& found, std::size_t e,
                                   const AttachedEffect& richer) {
  const std::span<const double> horizons = guided_horizons;
  const FitProblem& whole = search.problem.fit;
  const bool adds = adds_motion(*richer.effect, *found.effects[e].effect) && can_be_guided(search.bound, whole);
  FitProblem problem = whole;
  if (adds) {
    problem.recordings = search.problem.screened;
    problem.integration.follow = guided_follow(search.bound, problem, horizons.front());
  }
  Hypothesis best;
  double least = std::numeric_limits<double>::infinity();
  for (Hypothesis& one : starts_in_form(search, found, e, richer)) {
    if (search.problem.stopped()) break;
    if (adds) one = guided(search.bound, one, problem, horizons.first(1), search.parallel);
    const double loss = loss_of(search.bound, one, problem, search.parallel);
    if (!best.effects.empty() && !(loss < least)) continue;
    least = loss;
    best = std::move(one);
  }
  return adds && !best.effects.empty() ? guided(search.bound, best, whole, horizons.subspan(1), search.parallel) : best;
}

/// Places of the best fits of each form of effect number `e`, best first, at most `keep`.
SUREFOOT_ONCE std::vector<std::size_t> best_of_forms(const std::vector<Fit>& fits, std::size_t e, std::size_t keep) {
  std::vector<std::size_t> best;
  for (const std::size_t i :
       sorted_places(fits.size(), [&](std::size_t a, std::size_t b) { return fits[a].loss < fits[b].loss; })) {
    if (best.size() == keep) break;
    bool there = !fits[i].ok;  // or not begun: the search was stopped
    for (const std::size_t j : best) {
      there = there || same_effect(fits[j].hypothesis.effects[e], fits[i].hypothesis.effects[e]);
    }
    if (!there) best.push_back(i);
  }
  return best;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> in_other_forms(const Search& search, const EvaluatedHypothesis& found,
                                                              std::size_t e, std::size_t keep, bool finely) {
  constexpr double stiffer = 0.2;  // of the starts, which are where steps of a row can go
  const FitProblem quick = screening_fit(search.problem, search.problem.effort.first_iterations);
  const AttachedEffect& present = found.hypothesis.effects[e];
  std::vector<Hypothesis> starts;
  for (const AttachedEffect& one : search.candidates) {
    const bool other = same_but_for_form(one, present) && !same_effect(one, present);
    if (!other || !one.effect->extends.empty()) continue;
    for (const double factor : finely ? std::vector{1.0, stiffer} : std::vector{1.0}) {
      for (Hypothesis& start : starts_in_form(search, found.hypothesis, e, one, factor)) {
        starts.push_back(std::move(start));
      }
    }
  }
  std::vector<Fit> fits(starts.size());
  std::vector<Integration> finishing(starts.size(), search.problem.fit.integration);
  search.parallel(starts.size(), [&](std::size_t i) {
    if (search.problem.stopped()) return;
    FitProblem problem = quick;
    if (finely) {
      const auto [fitting, screening] = choose_integrations(search.bound, starts[i], quick.weighting.sigma,
                                                            finishing[i], quick.recordings, serially());
      if (is_finer(fitting, finishing[i])) finishing[i] = fitting;
      if (is_finer(screening, problem.integration)) problem.integration = screening;
    }
    fits[i] = fit(search.bound, starts[i], problem, serially());
  });
  std::vector<EvaluatedHypothesis> result;
  for (const std::size_t i : best_of_forms(fits, e, keep)) {
    Search as_fitted = search;
    as_fitted.problem.fit.integration = finishing[i];
    for (EvaluatedHypothesis& ready : finished(as_fitted, {fits[i]}, 1)) result.push_back(std::move(ready));
  }
  return result;
}

/// Whether a few iterations take away some of what a richer form must, and come nearer to what is to be reached.
SUREFOOT_ONCE bool promises(const Search& search, const EvaluatedHypothesis& found, const Hypothesis& start,
                            double reach) {
  const SearchProblem& problem = search.problem;
  FitProblem quick = screening_fit(problem, problem.effort.first_iterations);
  quick.integration = problem.fit.integration;  // richer forms may be stiffer
  const double before = loss_of(search.bound, found.hypothesis, quick, serially());
  const double needed = gain_for(std::log(problem.criteria.named_odds), found.errors);
  const Fit begun = fit(search.bound, start, quick, search.parallel);
  return begun.ok && begun.loss < (1 - needed / problem.effort.underestimated) * before &&
         comes_nearer(before, begun.loss, reach);
}

/// Not ok where it cannot help.
SUREFOOT_ONCE Fit fit_richer(const Search& search, const EvaluatedHypothesis& found, std::size_t e,
                             const AttachedEffect& richer, double reach) {
  const FitProblem& problem = search.problem.fit;
  Hypothesis start = with_form(search, found.hypothesis, e, richer);
  if (start.effects.empty()) return {};
  if (richer.effect->starts_anywhere) {
    FitProblem beginnings = problem;
    beginnings.free = Free::initial_only;
    const Fit first = fit(search.bound, start, beginnings, search.parallel);
    if (!first.ok || !(first.loss < found.loss)) return {};
    start = first.hypothesis;
  }
  if (!promises(search, found, start, reach)) return {};
  return fit(search.bound, start, problem, search.parallel);
}

SUREFOOT_ONCE std::optional<EvaluatedHypothesis> in_richer_forms(const Search& search, const EvaluatedHypothesis& found,
                                                                 ErrorsOfForm errors_of_form, double reach) {
  const SearchProblem& problem = search.problem;
  const double needed = std::log(problem.criteria.named_odds);
  EvaluatedHypothesis best = found;
  bool any = false;
  for (std::size_t e = problem.known; e < found.hypothesis.effects.size(); ++e) {
    for (const AttachedEffect& richer : search.candidates) {
      if (!extends(richer, best.hypothesis.effects[e]) || problem.stopped()) continue;
      const bool adds = adds_motion(*richer.effect, *best.hypothesis.effects[e].effect);
      const double goal = adds ? std::min(reach, loss_at_noise(best, problem)) : reach;
      const Fit fitted = fit_richer(search, best, e, richer, goal);
      if (!fitted.ok) continue;
      const auto odds_of = [&](const EvaluatedHypothesis& one) {
        const bool counted = errors_of_form == ErrorsOfForm::counted;
        return counted ? log_odds_of_forms(one, best, problem.criteria) : log_odds(one, best, problem.criteria);
      };
      const EvaluatedHypothesis ended = evaluate_fit(search.bound, fitted, problem, search.parallel);
      const EvaluatedHypothesis one = inside_bounds(search, ended, odds_of(ended) - needed);
      if (!(odds_of(one) > needed)) continue;
      if (adds && !explains(search, one)) continue;  // what moves by itself bends to what is not understood
      best = one;
      any = true;
    }
  }
  if (!any) return std::nullopt;
  return best;
}

}  // namespace surefoot::diagnosis
