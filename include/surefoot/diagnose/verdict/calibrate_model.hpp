// The model calibrated before anything is searched, in the way the noise asks for; with inputs and initial states as
// recordings show them where the model does not say, or says otherwise.
#pragma once

#include <vector>

#include "surefoot/diagnose/selection/choose_initial_states.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/run_context.hpp"

namespace surefoot::diagnosis {

/// The model before and after its parameters were calibrated.
struct Calibration {
  Hypothesis nominal;  // with the initial states of the training recordings
  Fit calibrated;
  std::vector<SimulatedRun> training_runs;  // of the calibrated model
  FreedTogether freed_together = {};        // another explanation of what it leaves
};

/// Calibrates, with an integration that is fine enough and in the way the noise asks for: fills in noise, integration,
/// weighting and sizes of the setup.
Calibration calibrate_model(EstimationSetup& setup, const RunContext& run);

/// The weights by which errors are compared.
Weighting error_scale_of(const EstimationSetup& setup);

/// Whether the residuals of a hypothesis hold what noise does not; final poses are too few to tell. Recordings that it
/// was not fitted to would tell of parameters.
bool holds_structure(const EstimationSetup& setup, const Hypothesis& hypothesis, const FitProblem& fit,
                     const SelectionCriteria& criteria, const Parallel& parallel);

/// Frees initial states that recordings refute, beside those before; true if there are any.
bool free_more_states(EstimationSetup& setup, Fit& fitted, const SearchProblem& problem, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/calibrate_model.ipp"
#endif
