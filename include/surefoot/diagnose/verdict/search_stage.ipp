// Definitions of surefoot/diagnose/verdict/search_stage.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/selection/choose_initial_states.hpp"
#include "surefoot/diagnose/verdict/evidence.hpp"
#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"
#include "surefoot/diagnose/verdict/search_stage.hpp"

namespace surefoot::diagnosis {

/// Effects that were asked for, but for those that these recordings cannot show.
SUREFOOT_ONCE std::vector<Effect> effects_to_seek(const EstimationSetup& setup, const RunContext& run) {
  const auto& names = run.options.effects;
  const bool reads = setup.noise != NoiseKind::process;  // else rows start from readings: no sensor's fault can be told
  const bool begins = !few_readings(setup.bound, setup.split.training);
  std::vector<Effect> sought;
  for (const Effect& effect : nameable_effects(run.options)) {
    const bool asked = names.empty() || std::find(names.begin(), names.end(), effect.name) != names.end();
    const bool shown = (reads || effect.place != Place::output) && (begins || !effect.starts_anywhere);
    if (asked && shown) sought.push_back(effect);
  }
  return sought;
}

SUREFOOT_ONCE std::vector<AttachedEffect> candidate_effects(const EstimationSetup& setup,
                                                            const Calibration& calibration, const RunContext& run) {
  std::vector<AttachedEffect> candidates = attachments(
      setup.bound, effects_to_seek(setup, run),
      distinct_inputs(setup.bound, calibration.calibrated.hypothesis, setup.split.training, calibration.training_runs));
  const bool map = setup.bound.info.kind == SimulatorKind::map;  // whose first row is the first command
  const std::vector<bool> zero = zero_at_first(setup.bound, setup.split.training);
  const InputValues values =
      input_values(setup.bound, calibration.calibrated.hypothesis, setup.split.training, calibration.training_runs);
  drop_items(candidates, [&](const AttachedEffect& one) {
    const auto at = static_cast<std::size_t>(one.at);
    const Effect& effect = *one.effect;
    return (effect.from_rest && (map || zero[at])) || (effect.needs_both_signs && !values.both_signs[at]) ||
           (effect.needs_small_values && !values.small_values[at]);
  });
  return candidates;
}

SUREFOOT_ONCE SearchProblem search_problem(const EstimationSetup& setup, const Calibration& calibration,
                                           const RunContext& run) {
  const auto& training = setup.split.training;
  SearchProblem problem;
  problem.fit = setup.problem;
  problem.scale = error_scale_of(setup);
  problem.noise.resize(problem.scale.sigma.size());
  for (Eigen::Index k = 0; k < problem.noise.size(); ++k) {
    const double amplified = amplification_of(setup.noise_of_predictions, static_cast<std::size_t>(k));
    const double ratio = noise_of(setup.bound, training, k) * amplified / problem.scale.sigma[k];
    problem.noise[k] = setup.noise == NoiseKind::measurement ? ratio * ratio : 0;
  }
  problem.nominal = calibration.nominal;
  problem.folds = setup.split.folds;
  problem.known = run.options.known.size();
  const double rival = calibration.freed_together.log_odds;
  if (rival > std::log(problem.criteria.named_odds)) problem.rival = rival;
  problem.criteria.max_effects = run.options.max_effects;
  const VerdictCriteria verdict;
  if (within_process_noise(process_ratio(setup, calibration.training_runs, verdict), verdict)) {
    problem.criteria.max_effects = 0;  // the machine is as it was
  }
  SearchEffort& effort = problem.effort;
  double rows = 1;  // small problems can afford a longer list
  for (const std::size_t r : training) rows += static_cast<double>(setup.bound.recordings[r].rows());
  const auto fewest = static_cast<double>(effort.shortlist), most = static_cast<double>(effort.max_shortlist);
  effort.shortlist = static_cast<std::size_t>(std::clamp(fewest * effort.shortlist_rows / rows, fewest, most));
  effort.compared_shortlist = effort.compared_shortlist * effort.shortlist / static_cast<std::size_t>(fewest);
  const bool final_poses = setup.noise == NoiseKind::final_pose;
  const bool few = final_poses || rows < effort.screening_rows;
  problem.screened =
      some_by_error(setup.bound, training, calibration.training_runs, few ? effort.screening_of_few : effort.screening);
  problem.on_progress = [run](const std::string& stage, double share) {
    run.progress(stage, progress_search + (progress_evaluation - progress_search) * share);
  };
  problem.stopped = [run] { return run.search_has_ended(); };
  problem.structured = [&setup, run, criteria = problem.criteria](const Hypothesis& hypothesis, const FitProblem& fit) {
    return holds_structure(setup, hypothesis, fit, criteria, run.parallel);
  };
  return problem;
}

SUREFOOT_ONCE void remove_outliers_from(EstimationSetup& setup, const Hypothesis& model, const RunContext& run,
                                        Diagnosis& diagnosis) {
  if (setup.noise != NoiseKind::measurement) return;
  BoundSimulator& bound = setup.bound;
  const auto runs = simulate_all(bound, model, setup.split.training, bound.integration, run.parallel);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i].finite) continue;
    const auto removed = remove_outliers(bound.info, bound.recordings[setup.split.training[i]], runs[i].outputs);
    append_items(diagnosis.remarks, removed);
  }
}

/// Lets these states begin anywhere in all recordings.
SUREFOOT_ONCE void free_all(EstimationSetup& setup, const std::vector<bool>& states) {
  setup.freed.resize(states.size(), false);
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i]) continue;
    setup.freed[i] = true;
    set_initial_scale(setup.bound, i, setup.bound.sizes.state[i]);
  }
}

SUREFOOT_ONCE Searched search_effects(EstimationSetup& setup, const RunContext& run, Diagnosis& diagnosis,
                                      const std::vector<Hypothesis>& begun) {
  run.progress("calibrating", progress_calibration);
  Searched found{calibrate_model(setup, run), {}, {}, {}};
  remove_outliers_from(setup, found.calibration.calibrated.hypothesis, run, diagnosis);
  found.problem = search_problem(setup, found.calibration, run);
  found.candidates = candidate_effects(setup, found.calibration, run);
  found.selection =
      select_effects(setup.bound, found.calibration.calibrated, found.problem, found.candidates, run.parallel, begun);
  if (found.selection.yields && !run.search_has_ended()) {
    free_all(setup, found.calibration.freed_together.states);
    return search_effects(setup, run, diagnosis);
  }
  return found;
}

/// Fits the model without effects once more: the search found that inputs or initial states are otherwise.
SUREFOOT_ONCE void calibrate_again(EstimationSetup& setup, Searched& found, const RunContext& run) {
  Fit& calibrated = found.calibration.calibrated;
  calibrated = fit(setup.bound, calibrated.hypothesis, found.selection.fit, run.parallel);
  const std::size_t known = calibrated.hypothesis.effects.size();
  found.selection.nominal.hypothesis = calibrated.hypothesis;
  EvaluatedHypothesis& chosen = found.selection.chosen;
  if (chosen.hypothesis.effects.size() == known) chosen.hypothesis = calibrated.hypothesis;
}

SUREFOOT_ONCE void take_over_inputs(EstimationSetup& setup, Searched& found, const RunContext& run) {
  const std::vector<InputHold>& inputs = found.selection.fit.integration.inputs;
  if (inputs == setup.bound.integration.inputs) return;
  setup.bound.integration.inputs = inputs;
  calibrate_again(setup, found, run);
}

/// The choice and its best alternatives, from the initial states of `fitted`.
SUREFOOT_ONCE std::vector<Hypothesis> best_with_initial_states(const Searched& found, const Hypothesis& fitted) {
  std::vector<Hypothesis> best{fitted};
  for (const EvaluatedHypothesis& one : found.selection.alternatives) {
    if (best.size() == found.problem.effort.finalists) break;
    if (one.hypothesis.effects.size() == found.problem.known) continue;
    best.push_back(one.hypothesis);
    best.back().initial = fitted.initial;
  }
  return best;
}

SUREFOOT_ONCE void revise_initial_states(EstimationSetup& setup, Searched& found, const RunContext& run,
                                         Diagnosis& diagnosis) {
  const auto chosen = [&] { return Fit{found.selection.chosen.hypothesis, found.selection.chosen.loss, true}; };
  const auto with_present_weights = [&] {
    SearchProblem problem = found.problem;
    problem.fit = found.selection.fit;
    return problem;
  };
  if (run.search_has_ended()) return;
  Fit fitted = chosen();
  if (free_more_states(setup, fitted, with_present_weights(), run.parallel)) {
    found = search_effects(setup, run, diagnosis, best_with_initial_states(found, fitted.hypothesis));
    fitted = chosen();
  }
  if (run.search_has_ended()) return;
  const std::vector<bool> before = setup.freed;
  restore_initial_states(setup.bound, setup.freed, fitted, with_present_weights(), run.parallel);
  if (setup.freed == before) return;
  found.selection.chosen.hypothesis = fitted.hypothesis;
  Hypothesis& calibrated = found.calibration.calibrated.hypothesis;
  for (std::size_t r = 0; r < setup.bound.recordings.size(); ++r) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto state = static_cast<Eigen::Index>(i);
      const bool restored = before[i] && !setup.freed[i];
      if (restored) calibrated.initial[r][state] = setup.bound.recordings[r].initial[state];
    }
  }
  calibrate_again(setup, found, run);
}

}  // namespace surefoot::diagnosis
