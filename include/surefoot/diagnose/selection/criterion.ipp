// Definitions of surefoot/diagnose/selection/criterion.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE EvaluatedHypothesis evaluate_fit(const BoundSimulator& bound, const Fit& fitted,
                                                 const SearchProblem& problem, const Parallel& parallel) {
  EvaluatedHypothesis result{fitted.hypothesis, fitted.loss, {}, {}};
  FitProblem quick = problem.fit;
  quick.max_iterations = problem.effort.fold_iterations;
  quick.tolerance = problem.effort.fold_tolerance;
  result.cross_validated = cross_validate(bound, fitted.hypothesis, quick, problem.folds, parallel).losses;
  return result;
}

SUREFOOT_INLINE bool simpler(const Hypothesis& a, const Hypothesis& b) {
  const auto measure = [](const Hypothesis& h) {
    std::pair<std::size_t, int> sum{0, 0};
    for (std::size_t e = 0; e < h.effects.size(); ++e) {
      sum.first += static_cast<std::size_t>(h.values[e].size());
      sum.second += h.effects[e].rank;
    }
    return sum;
  };
  return measure(a) < measure(b);
}

SUREFOOT_INLINE std::size_t most_plausible(const std::vector<EvaluatedHypothesis>& evaluated,
                                           const SelectionCriteria& criteria) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < evaluated.size(); ++i) {
    if (evaluated[i].cross_validated.total() < evaluated[best].cross_validated.total()) best = i;
  }
  std::size_t choice = best;
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    if (i == best || !simpler(evaluated[i].hypothesis, evaluated[choice].hypothesis)) continue;
    const Comparison lead = compare_losses(evaluated[i].cross_validated, evaluated[best].cross_validated);
    const bool fewer = evaluated[i].parameter_count() < evaluated[choice].parameter_count();
    const double gain = evaluated[i].gain.gain;
    const bool all_but = gain >= criteria.tie_gain_share * evaluated[best].gain.gain && gain > 0;
    if (lead.gain < criteria.tie_gain || (fewer && lead.t < criteria.tie_t) || all_but) choice = i;
  }
  return choice;
}

SUREFOOT_INLINE bool accepted(const Comparison& gain, double tests, double parent, const SelectionCriteria& criteria) {
  if (gain.gain * parent < criteria.least_share && gain.gain < criteria.decisive_gain) return false;
  const bool significant = gain.p_value * std::max(1.0, tests) <= criteria.significance;
  return gain.gain >= criteria.min_gain && gain.t >= criteria.min_t &&
         (significant || (gain.gain >= criteria.large_gain && gain.p_value <= criteria.large_gain_significance));
}

SUREFOOT_INLINE std::optional<std::size_t> most_plausible_accepted(const std::vector<EvaluatedHypothesis>& evaluated,
                                                                   double tests, double parent,
                                                                   const SelectionCriteria& criteria) {
  std::vector<EvaluatedHypothesis> believed;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    if (!accepted(evaluated[i].gain, tests, parent, criteria)) continue;
    believed.push_back(evaluated[i]);
    place.push_back(i);
  }
  if (believed.empty()) return std::nullopt;
  return place[most_plausible(believed, criteria)];
}

SUREFOOT_INLINE bool determined(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t known,
                                const FitProblem& problem, const Parallel& parallel,
                                const SelectionCriteria& criteria) {
  const StandardErrors errors = standard_errors(bound, hypothesis, problem, parallel);
  std::vector<bool> seen(hypothesis.effects.size(), false);
  for (std::size_t i = 0; i < errors.variables.size(); ++i) {
    const Variable& variable = errors.variables[i];
    if (variable.kind != Variable::Kind::effect) continue;
    const auto& parameters = hypothesis.effects[variable.index].effect->parameters;
    const bool any_strength = std::ranges::any_of(parameters, &EffectParameter::strength);
    if (any_strength ? !parameters[variable.item].strength : variable.item > 0) continue;
    const double value = hypothesis.values[variable.index][static_cast<Eigen::Index>(variable.item)];
    if (std::abs(value) > criteria.determined_deviations * errors.deviation[static_cast<Eigen::Index>(i)])
      seen[variable.index] = true;
  }
  return std::all_of(seen.begin() + static_cast<std::ptrdiff_t>(known), seen.end(), [](bool one) { return one; });
}

}  // namespace surefoot::diagnosis
