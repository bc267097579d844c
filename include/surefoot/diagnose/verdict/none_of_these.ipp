// Definitions of surefoot/diagnose/verdict/none_of_these.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/verdict/none_of_these.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double probability_of_none(const Selection& selection, const Eigen::VectorXd& noise,
                                         const SearchProblem& problem) {
  constexpr double parameters = 2, told_by = 5;  // [nat]: a parameter known to about 1 % of its range
  const SelectionCriteria& criteria = problem.criteria;
  EvaluatedHypothesis unknown = selection.chosen;
  for (Eigen::Index k = 0; k < noise.size(); ++k) {
    if (!(noise[k] > 0)) return 0;
    const double floor = VerdictCriteria{}.largest_ratio * noise[k] / problem.scale.sigma[k];
    for (Eigen::Index r = 0; r < unknown.errors.mean_squares.rows(); ++r) {
      double& square = unknown.errors.mean_squares(r, k);
      square = std::min(square, floor * floor);
    }
  }
  unknown.log_prior -= std::log(static_cast<double>(std::max<std::size_t>(1, selection.candidates))) +
                       parameters * (criteria.form_cost + told_by);
  return probabilities({selection.chosen, unknown}, criteria).back();
}

}  // namespace surefoot::diagnosis
