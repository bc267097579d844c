// Definitions of surefoot/diagnose/verdict/fitted_model.hpp.
#pragma once

#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE FittedModel simulate_model(const EstimationSetup& setup, const Hypothesis& hypothesis,
                                           const Parallel& parallel) {
  const BoundSimulator& bound = setup.bound;
  const auto &training = setup.split.training, &held_out = setup.split.held_out;
  FittedModel model;
  model.hypothesis = with_estimated_initial_states(bound, hypothesis, held_out, setup.problem, parallel);
  const auto simulated = [&](const std::vector<std::size_t>& recordings, const Integration& integration) {
    return simulate_all(bound, model.hypothesis, recordings, integration, parallel);
  };
  model.runs.training = simulated(training, bound.integration);
  model.runs.held_out = simulated(held_out, bound.integration);
  if (bound.integration.restart == 0) {
    model.runs.whole_training = model.runs.training;
    model.runs.whole_held_out = model.runs.held_out;
    return model;
  }
  Integration whole = bound.integration;
  whole.restart = 0;
  model.runs.whole_training = simulated(training, whole);
  model.runs.whole_held_out = simulated(held_out, whole);
  return model;
}

SUREFOOT_INLINE FittedModel fitted_model(const EstimationSetup& setup, const Hypothesis& hypothesis,
                                         const Parallel& parallel) {
  FittedModel model = simulate_model(setup, hypothesis, parallel);
  model.mismatch = measure_mismatch(setup.bound, setup.split.training, model.runs.training,
                                    setup.problem.weighting.sigma, setup.noise, &model.by_output);
  return model;
}

}  // namespace surefoot::diagnosis
