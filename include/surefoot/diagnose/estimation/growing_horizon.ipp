// Definitions of surefoot/diagnose/estimation/growing_horizon.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE BoundSimulator beginnings(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                        double share) {
  BoundSimulator result = bound;
  for (const std::size_t r : recordings) {
    Recording& recording = result.recordings[r];
    const Eigen::Index all = recording.rows(), least = std::min<Eigen::Index>(all, 2);
    const auto wanted = static_cast<Eigen::Index>(std::ceil(share * static_cast<double>(all)));
    recording = part_of(recording, 0, std::clamp(wanted, least, all), recording.initial, recording.initial_scale);
  }
  return result;
}

SUREFOOT_ONCE Fit grown_fit_of(const BoundSimulator& bound, Fit best, const Hypothesis& start,
                               const FitProblem& problem, const std::vector<std::size_t>& recordings,
                               const Parallel& parallel) {
  Fit grown{.hypothesis = start};
  for (const double share : {0.0625, 0.125, 0.25, 0.5}) {
    if (problem.stopped()) return best;
    const Fit longer = fit(beginnings(bound, recordings, share), grown.hypothesis, problem, parallel);
    if (longer.ok) grown = longer;
  }
  grown = fit(bound, grown.hypothesis, without_prior(problem), parallel);
  return grown.ok && grown.loss < clearly_less * best.loss ? grown : best;
}

SUREFOOT_ONCE Fit grown_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
                            const Parallel& parallel) {
  return grown_fit_of(bound, std::move(best), start, problem, problem.recordings, parallel);
}

SUREFOOT_ONCE Hypothesis with_grown_initial_states(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                   const std::vector<std::size_t>& recordings, FitProblem problem,
                                                   const Parallel& parallel) {
  Fit fitted{.hypothesis = with_estimated_initial_states(bound, hypothesis, recordings, problem, parallel)};
  problem.free = Free::initial_only;
  for (const std::size_t r : recordings) {
    if (!has_unknown_initial_state(bound.recordings[r])) continue;
    problem.recordings = {r};
    fitted.loss = loss_of(bound, fitted.hypothesis, problem, parallel);
    Hypothesis start = fitted.hypothesis;
    start.initial[r] = bound.recordings[r].initial;
    fitted = grown_fit(bound, fitted, start, problem, parallel);
  }
  return fitted.hypothesis;
}

}  // namespace surefoot::diagnosis
