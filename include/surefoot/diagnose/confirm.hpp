// The veto of the test recordings: effects that they do not confirm are not named, and what they still miss is
// admitted.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "surefoot/diagnose/calibrate.hpp"
#include "surefoot/diagnose/detect.hpp"
#include "surefoot/diagnose/investigation.hpp"
#include "surefoot/diagnose/recording_error.hpp"
#include "surefoot/diagnose/score.hpp"

namespace surefoot {

/// Whether effects lower the error of the test recordings in the units in which they were chosen, and do not raise it
/// where whole recordings are simulated. Both hypotheses need the initial states of those recordings.
inline bool confirmed(const Investigation& investigation, const Hypothesis& before, const Hypothesis& after,
                      const Parallel& parallel) {
  const Rig& rig = investigation.rig;
  const FitProblem& problem = investigation.problem.fit;
  const auto& test = investigation.split.test;
  const auto error = [&](const Hypothesis& one) {
    return score(rig, one, test, problem.weighting, problem.integration, parallel).rms();
  };
  const auto whole = [&](const Hypothesis& one) {
    return detail::whole_error(rig, one, test, rig.integration, parallel);
  };
  return error(after) < 0.98 * error(before) && whole(after) < 1.02 * whole(before);
}

/// What effects leave of the test recordings' squared errors beyond noise.
struct Remainder {
  double share = 0;  // of what there was without them
  double times = 0;  // root mean square, in units of the noise
};

/// Both hypotheses need the initial states of the test recordings.
inline Remainder remainder_on_test(const Investigation& investigation, const Hypothesis& calibrated,
                                   const Hypothesis& chosen, const Parallel& parallel) {
  const Rig& rig = investigation.rig;
  const FitProblem& problem = investigation.problem.fit;
  const auto& test = investigation.split.test;
  const auto sizes = [&](const Hypothesis& hypothesis) {
    return residual_sizes(rig, test, simulate_all(rig, hypothesis, test, problem.integration, parallel));
  };
  const Eigen::VectorXd before = sizes(calibrated), after = sizes(chosen), spreads = output_spreads(rig, test);
  double missed = 0, left = 0, squares = 0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    const bool stated = rig.info.outputs[static_cast<std::size_t>(k)].noise > 0;
    const double noise = stated ? noise_of(rig, test, k) : std::max(noise_of(rig, test, k), 1e-3 * spreads[k]);
    const double a = before[k] / noise, b = after[k] / noise;
    missed += std::max(0.0, a * a - 1);
    left += std::max(0.0, b * b - 1);
    squares += b * b / static_cast<double>(before.size());
  }
  return {missed > 0 ? left / missed : 0, std::sqrt(squares)};
}

}  // namespace surefoot
