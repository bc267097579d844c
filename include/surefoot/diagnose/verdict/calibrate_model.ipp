// Definitions of surefoot/diagnose/verdict/calibrate_model.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"
#include "surefoot/diagnose/selection/choose_initial_states.hpp"
#include "surefoot/diagnose/verdict/calibrate_model.hpp"
#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Weighting error_scale_of(const EstimationSetup& setup) {
  return {.sigma = error_scale(setup.bound), .whitening = setup.problem.weighting.whitening};
}

SUREFOOT_ONCE bool free_more_states(EstimationSetup& setup, Fit& fitted, const SearchProblem& problem,
                                    const Parallel& parallel) {
  if (setup.noise != NoiseKind::measurement) return false;
  const std::vector<bool> more = free_initial_states(setup.bound, fitted, problem, parallel);
  setup.freed.resize(more.size(), false);
  for (std::size_t i = 0; i < more.size(); ++i) setup.freed[i] = setup.freed[i] || more[i];
  return std::find(more.begin(), more.end(), true) != more.end();
}

SUREFOOT_ONCE bool holds_structure(const EstimationSetup& setup, const Hypothesis& hypothesis, const FitProblem& fit,
                                   const SelectionCriteria& criteria, const Parallel& parallel) {
  if (setup.noise == NoiseKind::final_pose) return true;
  const auto runs = simulate_all(setup.bound, hypothesis, fit.recordings, fit.integration, parallel);
  const Mismatch mismatch = measure_mismatch(setup.bound, fit.recordings, runs, setup.problem.weighting.sigma,
                                             setup.noise, setup.noise_of_predictions);
  return mismatch.p_value < criteria.structure_significance && mismatch.share > criteria.structure_share;
}

/// Frees initial states only if nothing else is missing then: beside other physics, which the search has yet to find,
/// they would absorb some of it.
SUREFOOT_ONCE bool free_states_alone(EstimationSetup& setup, Fit& calibrated, const SearchProblem& problem,
                                     const Parallel& parallel) {
  const std::vector<bool> before = setup.freed;
  Fit freed = calibrated;
  if (!free_more_states(setup, freed, problem, parallel)) return false;
  if (!holds_structure(setup, freed.hypothesis, problem.fit, problem.criteria, parallel)) {
    calibrated = freed;
    return true;
  }
  for (std::size_t i = 0; i < setup.freed.size(); ++i) {
    const bool already = i < before.size() && before[i];
    if (setup.freed[i] && !already) set_initial_scale(setup.bound, i, 0);
  }
  setup.freed = before;
  return false;
}

/// The subject of comparisons of calibrated models.
SUREFOOT_ONCE SearchProblem problem_of(const EstimationSetup& setup) {
  SearchProblem problem;
  problem.fit = setup.problem;
  problem.scale = error_scale_of(setup);
  return problem;
}

/// Inputs that are not held, and states that do not begin as the model says; true if recordings show any.
SUREFOOT_ONCE bool revise_what_was_said(EstimationSetup& setup, Fit& calibrated, const Parallel& parallel) {
  SearchProblem problem = problem_of(setup);
  const bool holds = choose_holds(setup.bound, calibrated, problem, parallel);
  setup.bound.integration = setup.problem.integration = problem.fit.integration;
  return free_states_alone(setup, calibrated, problem, parallel) || holds;
}

/// Initial states that may explain what the calibrated model leaves, all at once.
SUREFOOT_ONCE FreedTogether free_what_is_left(const EstimationSetup& setup, const Fit& calibrated,
                                              const RunContext& run) {
  const SearchProblem problem = problem_of(setup);
  if (setup.noise != NoiseKind::measurement || problem.fit.stopped() ||
      !holds_structure(setup, calibrated.hypothesis, problem.fit, problem.criteria, run.parallel)) {
    return {};
  }
  return free_together(setup.bound, calibrated, problem, run.options.starts, run.seed, run.parallel);
}

/// A calibration, or the fit from the nominal parameters on if these are better with the steps and weights that were
/// chosen since, each beginning where that suits it: a stiff model may have run away from them with coarser steps, and
/// what a sensor rounds hardly leads back to where it was.
SUREFOOT_ONCE Fit no_worse_than(const Hypothesis& nominal, const Fit& calibrated, const EstimationSetup& setup,
                                const Parallel& parallel) {
  const FitProblem& problem = setup.problem;
  const auto left_by = [&](const Hypothesis& one) {
    const double loss = loss_of(setup.bound, one, problem, parallel);
    return std::isfinite(loss) ? loss : std::numeric_limits<double>::infinity();
  };
  const Hypothesis begun = with_estimated_initial_states(setup.bound, nominal, problem.recordings, problem, parallel);
  if (!(left_by(begun) < left_by(calibrated.hypothesis))) return calibrated;
  const Fit again = fit(setup.bound, begun, problem, parallel);
  return again.ok ? again : calibrated;
}

SUREFOOT_ONCE Calibration calibrate_model(EstimationSetup& setup, const RunContext& run) {
  auto& [bound, split, noise, problem, noise_of_predictions, freed] = setup;
  const Parallel& parallel = run.parallel;
  const Hypothesis nominal = nominal_with_known(bound, run.options);
  noise = noise_kind(bound, nominal, split.training);
  bound.integration.restart = noise == NoiseKind::process ? 1 : 0;
  if (noise == NoiseKind::measurement) {
    free_measured_initial_states(bound, split.training);
    noise_of_predictions = prediction_noise(bound, nominal, split.training, parallel);
  }
  problem.integration = bound.integration;
  problem.stopped = [run] { return run.search_has_ended(); };
  if (!nominal.effects.empty()) {  // the bounds of their parameters are multiples of these
    bound.sizes = measure_sizes(bound, nominal, split.training,
                                simulate_all(bound, nominal, split.training, bound.integration, parallel));
  }
  Fit calibrated{nominal, 0, true};
  std::vector<SimulatedRun> runs;
  // One change shows the next: each input once, initial states, neither; errors of the integration show in the end.
  const std::size_t most_rounds = bound.info.inputs.size() + 2;
  bool changed = true;
  for (std::size_t round = 0; round < most_rounds && changed; ++round) {
    calibrated = calibrate(bound, calibrated.hypothesis, problem, run.options.starts, run.seed, parallel);
    bound.integration = choose_integration(bound, calibrated.hypothesis, problem.weighting.sigma, bound.integration,
                                           split.training, parallel);
    problem.integration = bound.integration;
    calibrated = no_worse_than(nominal, calibrated, setup, parallel);
    if (noise == NoiseKind::final_pose) {
      problem.weighting.whitening =
          final_pose_whitening(bound, calibrated.hypothesis, split.training, bound.integration);
    }
    calibrated = fit(bound, calibrated.hypothesis, problem, parallel);
    runs = simulate_all(bound, calibrated.hypothesis, split.training, bound.integration, parallel);
    bound.sizes = measure_sizes(bound, calibrated.hypothesis, split.training, runs);
    changed = revise_what_was_said(setup, calibrated, parallel);
  }
  if (is_refuted(noise_of_predictions, bound, split.training, runs)) {  // by the nominal parameters, far off
    noise_of_predictions = prediction_noise(bound, calibrated.hypothesis, split.training, parallel);
    if (is_refuted(noise_of_predictions, bound, split.training, runs)) noise_of_predictions = {};
  }
  return {with_estimated_initial_states(bound, nominal, split.training, problem, parallel), calibrated, runs,
          free_what_is_left(setup, calibrated, run)};
}

}  // namespace surefoot::diagnosis
