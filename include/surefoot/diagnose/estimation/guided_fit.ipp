// Definitions of surefoot/diagnose/estimation/guided_fit.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"

namespace surefoot::diagnosis {

/// Rows of a recording, on average.
SUREFOOT_ONCE double mean_rows(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  double rows = 0;
  for (const std::size_t r : recordings) rows += static_cast<double>(bound.recordings[r].rows());
  return rows / static_cast<double>(std::max<std::size_t>(1, recordings.size()));
}

SUREFOOT_ONCE Fit guided_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start,
                             const FitProblem& problem, const Parallel& parallel) {
  constexpr int iterations = 8;  // of each fit on the way: only a place to begin the next one from
  const bool measured = std::any_of(bound.structure.output_of.begin(), bound.structure.output_of.end(),
                                    [](int output) { return output >= 0; });
  if (!measured || problem.integration.restart > 0) return best;
  const double rows = mean_rows(bound, problem.recordings);
  Fit guided{.hypothesis = start};
  for (const double horizon : {1.0 / 64, 1.0 / 16, 1.0 / 4}) {  // shares of a recording
    if (problem.stopped()) return best;
    FitProblem near = problem;
    near.integration.follow = std::min(1.0, 1 / (horizon * rows));
    near.max_iterations = std::min(iterations, problem.max_iterations);
    const Fit one = fit(bound, guided.hypothesis, near, parallel);
    if (one.ok) guided = one;
  }
  guided = fit(bound, guided.hypothesis, problem, parallel);
  return guided.ok && guided.loss < clearly_less * best.loss ? guided : best;
}

}  // namespace surefoot::diagnosis
