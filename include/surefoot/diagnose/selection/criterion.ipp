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
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE EvaluatedHypothesis judge(const BoundSimulator& bound, const Fit& fitted, const SearchProblem& problem,
                                          const Parallel& parallel) {
  EvaluatedHypothesis result{fitted.hypothesis, fitted.loss, {}, {}};
  FitProblem quick = problem.fit;
  quick.max_iterations = 6;
  quick.tolerance = 1e-3;
  result.heldout = cross_validate(bound, fitted.hypothesis, quick, problem.folds, parallel).score;
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

SUREFOOT_INLINE std::size_t most_plausible(const std::vector<EvaluatedHypothesis>& judged) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < judged.size(); ++i) {
    if (judged[i].heldout.total() < judged[best].heldout.total()) best = i;
  }
  std::size_t choice = best;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (i == best || !simpler(judged[i].hypothesis, judged[choice].hypothesis)) continue;
    const Comparison lead = compare_losses(judged[i].heldout, judged[best].heldout);
    const bool fewer = judged[i].numbers() < judged[choice].numbers();
    const bool all_but = judged[i].gain.gain >= 0.985 * judged[best].gain.gain && judged[i].gain.gain > 0;
    if (lead.gain < 0.01 || (fewer && lead.t < 1.5) || all_but) choice = i;
  }
  return choice;
}

SUREFOOT_INLINE bool accepted(const Comparison& gain, std::size_t tried, double parent,
                              const SelectionCriteria& options) {
  if (gain.gain * parent < options.least_share && gain.gain < options.decisive_gain) return false;
  const bool significant = gain.p_value * static_cast<double>(std::max<std::size_t>(1, tried)) <= options.significance;
  return gain.gain >= options.min_gain && gain.t >= options.min_t &&
         (significant || (gain.gain >= options.large_gain && gain.p_value <= options.large_gain_significance));
}

SUREFOOT_INLINE std::optional<std::size_t> most_plausible_accepted(const std::vector<EvaluatedHypothesis>& judged,
                                                                   std::size_t tried, double parent,
                                                                   const SelectionCriteria& options) {
  std::vector<EvaluatedHypothesis> believed;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (!accepted(judged[i].gain, tried, parent, options)) continue;
    believed.push_back(judged[i]);
    place.push_back(i);
  }
  if (believed.empty()) return std::nullopt;
  return place[most_plausible(believed)];
}

SUREFOOT_INLINE bool determined(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t known,
                                const FitProblem& problem, const Parallel& parallel) {
  const StandardErrors errors = standard_errors(bound, hypothesis, problem, parallel);
  std::vector<bool> seen(hypothesis.effects.size(), false);
  for (std::size_t i = 0; i < errors.variables.size(); ++i) {
    const Variable& variable = errors.variables[i];
    if (variable.kind != Variable::Kind::effect) continue;
    const auto& parameters = hypothesis.effects[variable.index].effect->parameters;
    const bool any_strength = std::ranges::any_of(parameters, &EffectParameter::strength);
    if (any_strength ? !parameters[variable.item].strength : variable.item > 0) continue;
    const double value = hypothesis.values[variable.index][static_cast<Eigen::Index>(variable.item)];
    if (std::abs(value) > 2 * errors.deviation[static_cast<Eigen::Index>(i)]) seen[variable.index] = true;
  }
  return std::all_of(seen.begin() + static_cast<std::ptrdiff_t>(known), seen.end(), [](bool one) { return one; });
}

}  // namespace surefoot::diagnosis
