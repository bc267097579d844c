// Definitions of surefoot/diagnose/estimation/growing_horizon.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE BoundSimulator beginnings(const BoundSimulator& bound, double share) {
  BoundSimulator result = bound;
  for (Recording& recording : result.recordings) {
    const Eigen::Index all = recording.rows(), least = std::min<Eigen::Index>(all, 2);
    const auto wanted = static_cast<Eigen::Index>(std::ceil(share * static_cast<double>(all)));
    recording = part_of(recording, 0, std::clamp(wanted, least, all), recording.initial, recording.initial_scale);
  }
  return result;
}

SUREFOOT_ONCE Fit grown_fit(const BoundSimulator& bound, Fit best, const Hypothesis& start, const FitProblem& problem,
                            const Parallel& parallel) {
  Fit grown{.hypothesis = start};
  for (const double share : {0.0625, 0.125, 0.25, 0.5}) {
    if (problem.stopped()) return best;
    const Fit longer = fit(beginnings(bound, share), grown.hypothesis, problem, parallel);
    if (longer.ok) grown = longer;
  }
  grown = fit(bound, grown.hypothesis, without_prior(problem), parallel);
  return grown.ok && grown.loss < clearly_less * best.loss ? grown : best;
}

}  // namespace surefoot::diagnosis
