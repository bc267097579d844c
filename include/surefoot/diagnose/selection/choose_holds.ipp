// Definitions of surefoot/diagnose/selection/choose_holds.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"

namespace surefoot::diagnosis {

/// Whether two ways of integrating differ by more than what is lost in the residuals.
SUREFOOT_ONCE bool differ(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                          const Integration& other, const Parallel& parallel) {
  const Eigen::VectorXd& size = problem.weighting.sigma;
  const auto now = simulate_all(bound, hypothesis, problem.recordings, problem.integration, parallel);
  const auto then = simulate_all(bound, hypothesis, problem.recordings, other, parallel);
  const Eigen::VectorXd off = differences_of_runs(then, now, size.size());
  bool any = false;
  for (Eigen::Index k = 0; k < off.size(); ++k) any = any || off[k] > lost_in_residuals * size[k];
  return any;
}

SUREFOOT_ONCE bool choose_holds(const BoundSimulator& bound, Fit& fitted, SearchProblem& problem,
                                const Parallel& parallel) {
  if (bound.info.kind == SimulatorKind::map) return false;
  const auto evaluate = [&](const Fit& one, const FitProblem& with) {
    return EvaluatedHypothesis{
        one.hypothesis, one.loss,
        error_squares(bound, one.hypothesis, with.recordings, with.integration, problem.scale, parallel)};
  };
  bool changed = false;
  for (std::size_t i = 0; i < bound.info.inputs.size() && !problem.stopped(); ++i) {
    if (bound.info.inputs[i].linear.has_value()) continue;
    FitProblem other = problem.fit;
    other.integration.linear.resize(bound.info.inputs.size(), false);
    other.integration.linear[i] = !other.integration.linear[i];
    if (!differ(bound, fitted.hypothesis, problem.fit, other.integration, parallel)) continue;
    const Fit then = fit(bound, fitted.hypothesis, other, parallel);
    if (!then.ok) continue;
    const double odds = log_odds(evaluate(then, other), evaluate(fitted, problem.fit), problem.criteria);
    if (!(odds > std::log(problem.criteria.named_odds))) continue;
    problem.fit.integration = other.integration;
    fitted = then;
    changed = true;
  }
  return changed;
}

}  // namespace surefoot::diagnosis
