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

SUREFOOT_ONCE HeldOutErrors held_out_errors(const EstimationSetup& setup, const FittedModel& model) {
  const auto& held_out = setup.split.held_out;
  return {block_losses(setup.bound, held_out, model.runs.held_out, setup.problem.weighting).rms(),
          error_over_all(setup.bound, held_out, model.runs.whole_held_out)};
}

SUREFOOT_ONCE bool confirmed(const HeldOutErrors& without, const HeldOutErrors& with,
                             const HeldOutCriteria& criteria) {
  return with.weighted < criteria.error_ratio * without.weighted &&
         with.whole < criteria.whole_error_ratio * without.whole;
}

SUREFOOT_ONCE CheckedChoice check_on_held_out(const EstimationSetup& setup, const FittedModel& calibrated,
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
  Selection& changed = none.selection;
  std::swap(changed.chosen, changed.nominal);
  for (std::size_t i = 0; i < changed.alternatives.size(); ++i) {  // the model without effects and the choice change places
    if (changed.alternatives[i].hypothesis.effects.size() != calibrated.hypothesis.effects.size()) continue;
    std::swap(changed.probability, changed.alternative_probabilities[i]);
    changed.alternatives[i] = changed.nominal;
  }
  changed.nominal = changed.chosen;
  changed.evidence.clear();
  return none;
}

}  // namespace surefoot::diagnosis
