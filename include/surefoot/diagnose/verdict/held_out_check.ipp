// Definitions of surefoot/diagnose/verdict/held_out_check.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE HeldOutErrors held_out_errors(const EstimationSetup& setup, const FittedModel& model) {
  const auto& held_out = setup.split.held_out;
  return {block_losses(setup.bound, held_out, model.runs.held_out, setup.problem.weighting).rms(),
          error_over_all(setup.bound, held_out, model.runs.whole_held_out)};
}

SUREFOOT_INLINE bool confirmed(const HeldOutErrors& without, const HeldOutErrors& with,
                               const HeldOutCriteria& criteria) {
  return with.weighted < criteria.error_ratio * without.weighted &&
         with.whole < criteria.whole_error_ratio * without.whole;
}

SUREFOOT_INLINE CheckedChoice check_on_held_out(const EstimationSetup& setup, const FittedModel& calibrated,
                                                const Selection& selection, const HeldOutCriteria& criteria,
                                                const Parallel& parallel) {
  if (selection.chosen.hypothesis.effects.size() == calibrated.hypothesis.effects.size()) {
    return {selection, calibrated};
  }
  const FittedModel chosen = fitted_model(setup, selection.chosen.hypothesis, parallel);
  if (confirmed(held_out_errors(setup, calibrated), held_out_errors(setup, chosen), criteria)) {
    return {selection, chosen};
  }
  CheckedChoice none{selection, calibrated, true};
  none.selection.alternatives.assign(1, selection.chosen);
  none.selection.chosen = selection.nominal;
  return none;
}

SUREFOOT_INLINE HeldOutExcess held_out_excess(const EstimationSetup& setup, const FittedModel& calibrated,
                                              const FittedModel& chosen, const HeldOutCriteria& criteria) {
  const BoundSimulator& bound = setup.bound;
  const auto& held_out = setup.split.held_out;
  const Eigen::VectorXd before = residual_sizes(bound, held_out, calibrated.runs.held_out);
  const Eigen::VectorXd after = residual_sizes(bound, held_out, chosen.runs.held_out);
  const Eigen::VectorXd deviations = output_deviations(bound, held_out);
  double missed = 0, left = 0, squares = 0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    const bool stated = bound.info.outputs[static_cast<std::size_t>(k)].noise > 0;
    const double seen = noise_of(bound, held_out, k);
    const double noise = stated ? seen : std::max(seen, criteria.least_noise * deviations[k]);
    const double a = before[k] / noise, b = after[k] / noise;
    missed += std::max(0.0, a * a - 1);
    left += std::max(0.0, b * b - 1);
    squares += b * b / static_cast<double>(before.size());
  }
  return {missed > 0 ? left / missed : 0, std::sqrt(squares)};
}

}  // namespace surefoot::diagnosis
