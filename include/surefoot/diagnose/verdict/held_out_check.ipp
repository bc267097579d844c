// Definitions of surefoot/diagnose/verdict/held_out_check.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE bool confirmed(const Investigation& investigation, const Hypothesis& before, const Hypothesis& after,
                               const Parallel& parallel) {
  const BoundSimulator& bound = investigation.bound;
  const FitProblem& problem = investigation.problem.fit;
  const auto& test = investigation.split.test;
  const auto error = [&](const Hypothesis& one) {
    return block_losses(bound, one, test, problem.weighting, problem.integration, parallel).rms();
  };
  const auto whole = [&](const Hypothesis& one) { return whole_error(bound, one, test, bound.integration, parallel); };
  return error(after) < 0.98 * error(before) && whole(after) < 1.02 * whole(before);
}

SUREFOOT_INLINE Remainder left_on_held_out(const Investigation& investigation, const Hypothesis& calibrated,
                                           const Hypothesis& chosen, const Parallel& parallel) {
  const BoundSimulator& bound = investigation.bound;
  const FitProblem& problem = investigation.problem.fit;
  const auto& test = investigation.split.test;
  const auto sizes = [&](const Hypothesis& hypothesis) {
    return residual_sizes(bound, test, simulate_all(bound, hypothesis, test, problem.integration, parallel));
  };
  const Eigen::VectorXd before = sizes(calibrated), after = sizes(chosen), spreads = output_spreads(bound, test);
  double missed = 0, left = 0, squares = 0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    const bool stated = bound.info.outputs[static_cast<std::size_t>(k)].noise > 0;
    const double noise = stated ? noise_of(bound, test, k) : std::max(noise_of(bound, test, k), 1e-3 * spreads[k]);
    const double a = before[k] / noise, b = after[k] / noise;
    missed += std::max(0.0, a * a - 1);
    left += std::max(0.0, b * b - 1);
    squares += b * b / static_cast<double>(before.size());
  }
  return {missed > 0 ? left / missed : 0, std::sqrt(squares)};
}

}  // namespace surefoot::diagnosis
