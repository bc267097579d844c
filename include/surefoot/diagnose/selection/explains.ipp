// Definitions of surefoot/diagnose/selection/explains.hpp.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/explains.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE bool leaves_structure(const Search& search, const EvaluatedHypothesis& one) {
  return search.problem.structured(one.hypothesis, search.problem.fit);
}

SUREFOOT_ONCE bool explains(const Search& search, const EvaluatedHypothesis& one) {
  return leaves_only_noise(one, search.problem) || !leaves_structure(search, one);
}

SUREFOOT_ONCE double loss_at_noise(const EvaluatedHypothesis& one, const SearchProblem& problem) {
  const Eigen::VectorXd left = pooled(one.errors);
  double share = 0;
  for (Eigen::Index k = 0; k < left.size(); ++k) {
    const double noise = (1 + problem.criteria.tolerated_form) * (k < problem.noise.size() ? problem.noise[k] : 0);
    share += noise > 0 && noise < left[k] ? noise / left[k] : 1;
  }
  return one.loss * share / static_cast<double>(left.size());
}

SUREFOOT_ONCE bool yields(const Search& search, const std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const auto none = find_item(pool, [&](const auto& one) { return search.effects(one) == 0; });
  return none != nullptr && log_odds(pool[best_of(pool, criteria)], *none, criteria) < search.problem.rival;
}

}  // namespace surefoot::diagnosis
