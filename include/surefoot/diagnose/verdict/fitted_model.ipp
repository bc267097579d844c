// Definitions of surefoot/diagnose/verdict/fitted_model.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace surefoot::diagnosis {

/// By held-out recording: the fit to all folds but its own.
SUREFOOT_ONCE std::vector<Hypothesis> cross_fitted(const EstimationSetup& setup, const Hypothesis& hypothesis,
                                                   bool refit, const Parallel& parallel) {
  const auto& [training, held_out, folds, cross_fitted] = setup.split;
  std::vector<Hypothesis> result(held_out.size(), hypothesis);
  if (!refit) return result;
  const std::vector<Hypothesis> fits = fits_to_other_folds(setup.bound, hypothesis, setup.problem, folds, parallel);
  for (std::size_t k = 0; k < folds.size(); ++k) {
    for (const std::size_t r : folds[k]) {
      result[static_cast<std::size_t>(std::find(held_out.begin(), held_out.end(), r) - held_out.begin())] = fits[k];
    }
  }
  return result;
}

SUREFOOT_ONCE FittedModel simulate_model(const EstimationSetup& setup, const Hypothesis& hypothesis,
                                         const Parallel& parallel, bool refit) {
  const BoundSimulator& bound = setup.bound;
  const auto &training = setup.split.training, &held_out = setup.split.held_out;
  FittedModel model;
  model.hypothesis = hypothesis;
  std::vector<Hypothesis> unseen;  // by held-out recording
  if (setup.split.cross_fitted) {
    unseen = cross_fitted(setup, hypothesis, refit, parallel);
  } else {
    model.hypothesis = with_grown_initial_states(bound, hypothesis, held_out, setup.problem, parallel);
    unseen = std::vector<Hypothesis>(held_out.size(), model.hypothesis);
  }
  const auto of_training = [&](const Integration& integration) {
    return simulate_all(bound, model.hypothesis, training, integration, parallel);
  };
  const auto of_held_out = [&](const Integration& integration) {
    std::vector<SimulatedRun> runs(held_out.size());
    parallel(held_out.size(), [&](std::size_t i) { runs[i] = simulate(bound, unseen[i], held_out[i], integration); });
    return runs;
  };
  model.runs.training = of_training(bound.integration);
  model.runs.held_out = of_held_out(bound.integration);
  if (bound.integration.restart == 0) {
    model.runs.whole_training = model.runs.training;
    model.runs.whole_held_out = model.runs.held_out;
    return model;
  }
  Integration whole = bound.integration;
  whole.restart = 0;
  model.runs.whole_training = of_training(whole);
  model.runs.whole_held_out = of_held_out(whole);
  return model;
}

SUREFOOT_ONCE FittedModel fitted_model(const EstimationSetup& setup, const Hypothesis& hypothesis,
                                       const Parallel& parallel) {
  FittedModel model = simulate_model(setup, hypothesis, parallel, true);
  model.mismatch =
      measure_mismatch(setup.bound, setup.split.training, model.runs.training, setup.problem.weighting.sigma,
                       setup.noise, setup.noise_of_predictions, &model.by_output);
  return model;
}

}  // namespace surefoot::diagnosis
