// The final check on held-out recordings, which can reject: effects that they do not confirm are not named.
#pragma once

#include "surefoot/diagnose/selection/search.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace surefoot::diagnosis {

/// When held-out recordings confirm effects. Ratios of root mean square errors, with effects against without.
struct HeldOutCriteria {
  double error_ratio = 0.98;        // in the units in which effects were chosen: 2 % less at least
  double whole_error_ratio = 1.02;  // of whole recordings: 2 % more at most, as errors may add up by chance
};

/// Errors of a model on the held-out recordings.
struct HeldOutErrors {
  double weighted = 0;  // as the noise asks for, in units of the weighting
  double whole = 0;     // of whole recordings, in units of error_scale()
};

HeldOutErrors held_out_errors(const EstimationSetup& setup, const FittedModel& model);

/// Whether effects lower the error of the held-out recordings in the units in which they were chosen, and do not raise
/// it where whole recordings are simulated.
bool confirmed(const HeldOutErrors& without, const HeldOutErrors& with, const HeldOutCriteria& criteria);

/// The choice after the check.
struct CheckedChoice {
  Selection selection;  // if rejected: nothing is chosen, and what was rejected is the alternative
  FittedModel chosen;
  bool rejected = false;
};

/// `calibrated` is the model without effects that `selection` began with.
CheckedChoice check_on_held_out(const EstimationSetup& setup, const FittedModel& calibrated, const Selection& selection,
                                const HeldOutCriteria& criteria, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/held_out_check.ipp"
#endif
