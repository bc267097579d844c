// The veto of the test recordings: effects that they do not confirm are not named, and what they still miss is
// admitted.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"

namespace surefoot::diagnosis {

/// Whether effects lower the error of the test recordings in the units in which they were chosen, and do not raise it
/// where whole recordings are simulated. Both hypotheses need the initial states of those recordings.
bool confirmed(const Investigation& investigation, const Hypothesis& before, const Hypothesis& after,
               const Parallel& parallel);

/// What effects leave of the test recordings' squared errors beyond noise.
struct Remainder {
  double share = 0;  // of what there was without them
  double times = 0;  // root mean square, in units of the noise
};

/// Both hypotheses need the initial states of the test recordings.
Remainder left_on_held_out(const Investigation& investigation, const Hypothesis& calibrated, const Hypothesis& chosen,
                           const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/held_out_check.ipp"
#endif
