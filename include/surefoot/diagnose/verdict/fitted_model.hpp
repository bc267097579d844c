// Fitted models: hypotheses with what they simulate, made once and handed on as values.
#pragma once

#include <vector>

#include "surefoot/diagnose/estimation/data_split.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/mismatch.hpp"

namespace surefoot::diagnosis {

/// The subject of all estimates: recordings bound to the simulator, which of them are held out, what their noise is
/// like, and how residuals are therefore weighted.
struct EstimationSetup {
  BoundSimulator bound;
  RecordingSplit split;
  NoiseKind noise = NoiseKind::measurement;
  FitProblem problem = {};                    // of the training recordings
  PredictionNoise noise_of_predictions = {};  // of the model as it is, if it follows the readings
  std::vector<bool> freed = {};  // states of which the model said where they begin, and recordings otherwise
};

/// Simulations by a model; each list goes with the training or the held-out recordings.
struct ModelRuns {
  std::vector<SimulatedRun> training, held_out;              // as the noise asks for (Integration::restart)
  std::vector<SimulatedRun> whole_training, whole_held_out;  // from the initial states to the end
};

struct FittedModel {
  Hypothesis hypothesis;  // with the initial states of all recordings
  ModelRuns runs;
  Mismatch mismatch;                     // of the training runs
  std::vector<WhitenessTest> by_output;  // of the training runs
};

/// The model as it is, as it is calibrated, and with the effects that were chosen.
struct FittedModels {
  FittedModel nominal, calibrated, chosen;
};

/// Simulates everything; the mismatch is not measured. Held-out recordings are simulated with their own initial states
/// estimated and, where each is held out once, by the fit to the others, if there is anything to `refit`.
FittedModel simulate_model(const EstimationSetup& setup, const Hypothesis& hypothesis, const Parallel& parallel,
                           bool refit = false);

/// The same with the mismatch.
FittedModel fitted_model(const EstimationSetup& setup, const Hypothesis& hypothesis, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/fitted_model.ipp"
#endif
