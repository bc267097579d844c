// Definitions of surefoot/diagnose/estimation/trimmed_fit.hpp.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/estimation/trimmed_fit.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Fit trimmed_fit(const BoundSimulator& bound, Fit best, FitProblem problem, const Parallel& parallel) {
  const std::vector<std::size_t> all = problem.recordings;
  if (all.size() < 3) return best;
  std::vector<double> losses;
  for (const std::size_t r : all) {
    problem.recordings = {r};
    losses.push_back(loss_of(bound, best.hypothesis, problem, parallel));
  }
  const auto order = sorted_places(all.size(), [&](std::size_t a, std::size_t b) { return losses[a] < losses[b]; });
  problem.recordings.clear();
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < all.size(); ++i) {
    (2 * i < all.size() ? problem.recordings : others).push_back(all[order[i]]);
  }
  const Hypothesis of_some = fit(bound, best.hypothesis, problem, parallel).hypothesis;
  problem.recordings = all;
  const Hypothesis near = with_grown_initial_states(bound, of_some, others, problem, parallel);
  const Fit at_once = fit(bound, near, problem, parallel);
  if (at_once.ok && at_once.loss < clearly_less * best.loss) return at_once;
  return grown_fit_of(bound, best, near, problem, others, parallel);
}

}  // namespace surefoot::diagnosis
