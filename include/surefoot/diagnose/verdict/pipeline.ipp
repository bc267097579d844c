// Definitions of surefoot/diagnose/verdict/pipeline.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/data_split.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/selection/search.hpp"
#include "surefoot/diagnose/verdict/pipeline.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE std::vector<Recording> cut_recordings(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                      const std::vector<SimulatedRun>& trajectories,
                                                      std::size_t parts) {
  std::vector<Recording> result;
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    const Recording& whole = bound.recordings[r];
    const Eigen::MatrixXd& states = trajectories[r].states;
    for (std::size_t part = 0; part < parts; ++part) {
      const auto count = static_cast<Eigen::Index>(parts), k = static_cast<Eigen::Index>(part);
      const Eigen::Index from = whole.rows() * k / count, to = whole.rows() * (k + 1) / count;
      if (to - from < 20) continue;
      Eigen::VectorXd initial = states.col(from), scale(initial.size());
      for (Eigen::Index i = 0; i < initial.size(); ++i) {
        scale[i] = std::max(0.2 * root_mean_square(states.row(i)), 1e-6);
        const int output = bound.structure.output_of[static_cast<std::size_t>(i)];
        if (output < 0) continue;
        const double measured = whole.outputs(output, from);
        if (std::isfinite(measured)) initial[i] = measured;
      }
      Recording one = part_of(whole, from, to, initial, scale);
      if (part == 0) one.initial = hypothesis.initial[r];
      result.push_back(std::move(one));
    }
  }
  return result;
}

SUREFOOT_INLINE void free_measured_starts(BoundSimulator& bound, const std::vector<std::size_t>& training) {
  const Eigen::VectorXd spreads = output_spreads(bound, training);
  for (std::size_t i = 0; i < bound.info.states.size(); ++i) {
    const int output = bound.structure.output_of[i];
    if (output < 0) continue;
    const double noise = noise_of(bound, training, output), spread = spreads[output];
    for (Recording& recording : bound.recordings) {
      const auto state = static_cast<Eigen::Index>(i);
      if (recording.initial_scale[state] > 0 || recording.initial[state] != recording.outputs(output, 0)) continue;
      if (noise > 1e-6 * spread) recording.initial_scale[state] = noise;
    }
  }
}

SUREFOOT_INLINE std::vector<std::size_t> some_of(const std::vector<std::size_t>& recordings, std::size_t count) {
  if (recordings.size() <= count) return recordings;
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(recordings[i * recordings.size() / count]);
  return result;
}

SUREFOOT_INLINE Investigation run_pipeline(const std::function<BoundSimulator(std::vector<Recording>)>& make,
                                           const SimulatorInfo& info, std::vector<Recording> recordings,
                                           const DiagnoseOptions& options, const Parallel& parallel, std::uint64_t seed,
                                           std::stop_token stop) {
  const auto began = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };
  const auto progress = [&](std::string_view stage, double share, const std::string& best) {
    if (options.progress) options.progress(stage, share, best);
  };
  Investigation result;
  Diagnosis& diagnosis = result.diagnosis;
  diagnosis.model = info.name;
  diagnosis.seed = seed;

  // Screen.
  progress("screening", 0.0, "");
  if (recordings.empty()) throw DiagnoseError("there is no recording to diagnose");
  for (Recording& recording : recordings) {
    check_recording(info, recording);
    const auto wild = remove_outliers(info, recording);
    diagnosis.remarks.insert(diagnosis.remarks.end(), wild.begin(), wild.end());
  }
  const auto screened = screen(info, recordings);
  diagnosis.remarks.insert(diagnosis.remarks.end(), screened.begin(), screened.end());

  const std::vector<Effect> every = [&] {
    std::vector<Effect> list = all_effects();
    list.insert(list.end(), options.more_effects.begin(), options.more_effects.end());
    return list;
  }();
  const auto with_known = [&](Hypothesis hypothesis) {
    for (const NamedEffect& named : options.known) {
      hypothesis.effects.push_back(attach(info, named, every));
      hypothesis.values.emplace_back(
          Eigen::Map<const Eigen::VectorXd>(named.values.data(), static_cast<Eigen::Index>(named.values.size())));
    }
    return hypothesis;
  };

  // Few recordings are cut into parts.
  if (recordings.size() < 4 && options.test.empty()) {
    BoundSimulator whole = make(recordings);
    FitProblem quick;
    for (std::size_t r = 0; r < recordings.size(); ++r) quick.recordings.push_back(r);
    quick.integration = whole.integration;
    const Fit fitted = calibrate(whole, with_known(nominal_hypothesis(whole)), quick, options.starts, seed, parallel);
    const auto trajectories = simulate_all(whole, fitted.hypothesis, quick.recordings, whole.integration, parallel);
    const std::size_t parts = (5 + recordings.size() - 1) / recordings.size();
    std::vector<Recording> cut = cut_recordings(whole, fitted.hypothesis, trajectories, parts);
    if (cut.size() >= 3) recordings = std::move(cut);
  }
  if (recordings.size() < 2) {
    throw DiagnoseError(
        "one short recording is not enough to tell what is missing: record at least two, or one of 60 rows");
  }
  BoundSimulator& bound = result.bound;
  bound = make(recordings);
  const RecordingSplit split = split_recordings(bound.recordings, options.test, options.test_share, 4, seed);
  result.split = split;
  for (const std::size_t r : split.training) diagnosis.fit.push_back(bound.recordings[r].name);
  diagnosis.select = diagnosis.fit;  // cross-validated: each is held out once
  for (const std::size_t r : split.test) diagnosis.test.push_back(bound.recordings[r].name);

  // Calibrate, with an integration that is fine enough and in the way the noise asks for.
  progress("calibrating", 0.05, "");
  SearchProblem problem;
  problem.fit.recordings = split.training;
  Hypothesis nominal = with_known(nominal_hypothesis(bound));
  result.noise = noise_kind(bound, nominal, split.training);
  bound.integration.restart = result.noise == NoiseKind::process ? 1 : 0;
  if (result.noise == NoiseKind::measurement) free_measured_starts(bound, split.training);
  problem.fit.integration = bound.integration;
  Fit calibrated = calibrate(bound, nominal, problem.fit, options.starts, seed, parallel);
  bound.integration = choose_integration(bound, calibrated.hypothesis, problem.fit.weighting.sigma, bound.integration,
                                         split.training.front());
  problem.fit.integration = bound.integration;
  if (result.noise == NoiseKind::final_pose) {
    problem.fit.weighting.whitening =
        final_pose_whitening(bound, calibrated.hypothesis, split.training, bound.integration);
  }
  calibrated = fit(bound, calibrated.hypothesis, problem.fit, parallel);
  const auto trajectories = simulate_all(bound, calibrated.hypothesis, split.training, bound.integration, parallel);
  bound.sizes = measure_sizes(bound, calibrated.hypothesis, split.training, trajectories);

  // Is the nominal simulator good enough as it is?
  nominal = with_estimated_starts(bound, nominal, split.training, problem.fit, parallel);
  const BlockLosses before =
      block_losses(bound, nominal, split.training, problem.fit.weighting, bound.integration, parallel);

  // Propose, fit and select.
  problem.folds = split.folds;
  problem.known = options.known.size();
  problem.screened = some_of(split.training, result.noise == NoiseKind::final_pose ? 1000 : 5);
  problem.progress = [&](const std::string& stage, double share) { progress(stage, 0.15 + 0.7 * share, ""); };
  problem.stopped = [&] {
    return stop.stop_requested() || (options.max_seconds > 0 && seconds() > options.max_seconds);
  };
  problem.structured = [&](const Hypothesis& hypothesis) {
    if (result.noise == NoiseKind::final_pose) return true;
    const auto runs = simulate_all(bound, hypothesis, split.training, bound.integration, parallel);
    const Mismatch mismatch = measure_mismatch(bound, split.training, runs, problem.fit.weighting.sigma, result.noise);
    return mismatch.p_value < 0.02 && mismatch.share > 0.03;
  };
  std::vector<Effect> effects = every;
  if (!options.effects.empty()) {
    for (const std::string& name : options.effects) {
      if (std::none_of(effects.begin(), effects.end(), [&](const Effect& effect) { return effect.name == name; })) {
        throw DiagnoseError("there is no effect called '" + name + "'");
      }
    }
    std::erase_if(effects, [&](const Effect& effect) {
      return std::find(options.effects.begin(), options.effects.end(), effect.name) == options.effects.end();
    });
  }
  if (result.noise == NoiseKind::process) {  // each row starts from readings, so that a sensor's faults cannot be told
    std::erase_if(effects, [](const Effect& effect) { return effect.place == Place::output; });
  }
  const std::vector<AttachedEffect> candidates =
      attachments(bound, effects, distinct_inputs(bound, calibrated.hypothesis, split.training, trajectories));
  SelectionCriteria search;
  search.max_effects = options.max_effects;
  double rows = 1;  // small problems can afford a longer list
  for (const std::size_t r : split.training) rows += static_cast<double>(bound.recordings[r].rows());
  search.shortlist = static_cast<std::size_t>(std::clamp(14 * 6000 / rows, 14.0, 50.0));
  result.selection = select_effects(bound, calibrated, problem, candidates, search, parallel);
  result.problem = problem;
  result.nominal = nominal;
  result.parameters_matter = compare_losses(before, result.selection.nominal.heldout);
  diagnosis.complete = !stop.stop_requested();

  // Locate what the calibrated model misses, and conclude.
  progress("concluding", 0.9, "");
  conclude(result, candidates, parallel, seed);
  diagnosis.seconds = seconds();
  progress("done", 1, diagnosis.sentence);
  return result;
}

}  // namespace surefoot::diagnosis
