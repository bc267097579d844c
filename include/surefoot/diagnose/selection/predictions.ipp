// Definitions of surefoot/diagnose/selection/predictions.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/predictions.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE ErrorSquares errors_of_predictions(const Search& search, const EvaluatedHypothesis& one) {
  const SearchProblem& problem = search.problem;
  const std::vector<std::size_t>& recordings = problem.fit.recordings;
  const auto fits = fits_to_other_folds(search.bound, one.hypothesis, problem.fit, problem.folds, serially());
  ErrorSquares result = one.errors;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const std::vector<std::size_t>& fold = problem.folds[k];
    const ErrorSquares unseen =
        error_squares(search.bound, fits[k], fold, problem.fit.integration, problem.scale, serially());
    for (std::size_t i = 0; i < fold.size(); ++i) {
      const auto row = std::find(recordings.begin(), recordings.end(), fold[i]) - recordings.begin();
      for (Eigen::Index c = 0; c < result.mean_squares.cols(); ++c) {
        result.mean_squares(row, c) = unseen.mean_squares(static_cast<Eigen::Index>(i), c);
      }
    }
  }
  const Eigen::VectorXd left = pooled(result);
  for (Eigen::VectorXd* least : {&result.least, &result.least_elsewhere}) {
    for (Eigen::Index k = 0; k < least->size(); ++k) (*least)[k] = std::min((*least)[k], left[k]);
  }
  return result;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> with_predictions(const Search& search,
                                                                const std::vector<EvaluatedHypothesis>& pool) {
  const SearchProblem& problem = search.problem;
  if (problem.folds.size() < 2 || problem.stopped()) return pool;
  const bool by_predictions = problem.structured(pool[best_of(pool, problem.criteria)].hypothesis, problem.fit);
  const double behind = by_predictions ? problem.effort.hopeless : std::log(problem.criteria.tie_odds);
  std::vector<EvaluatedHypothesis> best = best_structures(pool, problem.effort.predicted, behind, problem.criteria);
  const auto is_bare = [&](const EvaluatedHypothesis& one) { return search.effects(one) == 0; };
  const auto bare = find_item(pool, is_bare);
  if (!holds_for_any(best, is_bare) && bare != nullptr) best.push_back(*bare);
  search.parallel(best.size(), [&](std::size_t i) {
    const ErrorSquares errors = errors_of_predictions(search, best[i]);
    best[i].predicted = errors.rms();
    if (by_predictions) best[i].errors = errors;
  });
  if (by_predictions) return best;
  std::vector<EvaluatedHypothesis> result = pool;
  for (EvaluatedHypothesis& one : result) {
    for (const EvaluatedHypothesis& other : best) {
      if (same_structure(other.hypothesis, one.hypothesis)) one.predicted = other.predicted;
    }
  }
  return result;
}

SUREFOOT_ONCE void restore_errors_of_fits(Selection& selection, const std::vector<EvaluatedHypothesis>& pool) {
  const auto restore = [&](EvaluatedHypothesis& one) {
    const auto fitted = find_item(
        pool, [&](const EvaluatedHypothesis& other) { return same_structure(other.hypothesis, one.hypothesis); });
    if (fitted != nullptr) one.errors = fitted->errors;
  };
  restore(selection.nominal);
  restore(selection.chosen);
  for (EvaluatedHypothesis& other : selection.alternatives) restore(other);
}

}  // namespace surefoot::diagnosis
