// Definitions of surefoot/diagnose/estimation/guided_fit.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"

namespace surefoot::diagnosis {

/// Rows of a recording, on average.
SUREFOOT_ONCE double mean_rows(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  double rows = 0;
  for (const std::size_t r : recordings) rows += static_cast<double>(bound.recordings[r].rows());
  return rows / static_cast<double>(std::max<std::size_t>(1, recordings.size()));
}

SUREFOOT_ONCE bool can_follow(const BoundSimulator& bound) {
  const auto& output_of = bound.structure.output_of;
  return holds_for_any(output_of, [](int output) { return output >= 0; });
}

SUREFOOT_ONCE bool can_be_guided(const BoundSimulator& bound, const FitProblem& problem) {
  return problem.integration.restart == 0 && can_follow(bound);
}

SUREFOOT_ONCE double guided_follow(const BoundSimulator& bound, const FitProblem& problem, double horizon) {
  return std::clamp(1 / (horizon * mean_rows(bound, problem.recordings)), problem.integration.follow, 1.0);
}

SUREFOOT_ONCE Hypothesis guided(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
                                std::span<const double> horizons, const Parallel& parallel) {
  constexpr int iterations = 8;  // of each fit on the way: only a place to begin the next one from
  if (!can_be_guided(bound, problem)) return start;
  Hypothesis reached = start;
  for (const double horizon : horizons) {
    if (problem.stopped()) break;
    FitProblem near = problem;
    near.integration.follow = guided_follow(bound, problem, horizon);
    near.max_iterations = std::min(iterations, problem.max_iterations);
    const Fit one = fit(bound, reached, near, parallel);
    if (one.ok) reached = one.hypothesis;
  }
  return reached;
}

SUREFOOT_ONCE Fit guided_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
                             const Parallel& parallel) {
  if (!can_be_guided(bound, problem)) return best;
  const Hypothesis reached = guided(bound, start, problem, guided_horizons, parallel);
  if (problem.stopped()) return best;
  const Fit one = fit(bound, reached, without_prior(problem), parallel);
  return one.ok && one.loss < clearly_less * best.loss ? one : best;
}

}  // namespace surefoot::diagnosis
