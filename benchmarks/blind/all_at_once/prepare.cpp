#include "prepare.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"

using namespace surefoot::diagnosis;

namespace all_at_once {

Preparation prepare(const BindSimulator& bind, const surefoot::SimulatorInfo& info,
                    std::vector<surefoot::Recording> recordings, const surefoot::DiagnoseOptions& options,
                    const Parallel& parallel, std::uint64_t seed) {
  if (recordings.size() < 4) {
    throw surefoot::DiagnoseError("this baseline needs at least four recordings, for the penalty and for the test; " +
                                  std::to_string(recordings.size()) + " given");
  }
  Preparation result;
  surefoot::Diagnosis& diagnosis = result.diagnosis;
  diagnosis.model = info.name;
  diagnosis.seed = seed;
  for (surefoot::Recording& recording : recordings) {
    check_recording(info, recording);
    const auto outliers = remove_outliers(info, recording);
    diagnosis.remarks.insert(diagnosis.remarks.end(), outliers.begin(), outliers.end());
  }
  BoundSimulator& bound = result.setup.bound;
  bound = bind(std::move(recordings));
  result.setup.split = split_recordings(bound.recordings, options.held_out, options.held_out_share, 4, seed);
  const auto& training = result.setup.split.training;
  for (const std::size_t r : training) diagnosis.fit.push_back(bound.recordings[r].name);
  for (const std::size_t r : result.setup.split.held_out) diagnosis.held_out.push_back(bound.recordings[r].name);
  diagnosis.select = diagnosis.fit;

  result.nominal = nominal_hypothesis(bound);
  for (const surefoot::NamedEffect& known : options.known) {
    result.nominal.effects.push_back(attach(info, known, surefoot::all_effects()));
    result.nominal.values.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(known.values.data(), static_cast<Eigen::Index>(known.values.size())));
  }
  FitProblem& problem = result.setup.problem;
  problem.recordings = training;
  result.setup.noise = noise_kind(bound, result.nominal, training);
  bound.integration.restart = result.setup.noise == NoiseKind::process ? 1 : 0;
  problem.integration = bound.integration;
  Fit calibrated = calibrate(bound, result.nominal, problem, options.starts, seed, parallel);
  bound.integration =
      choose_integration(bound, calibrated.hypothesis, problem.weighting.sigma, bound.integration, training.front());
  problem.integration = bound.integration;
  if (result.setup.noise == NoiseKind::final_pose) {
    problem.weighting.whitening = final_pose_whitening(bound, calibrated.hypothesis, training, bound.integration);
  }
  calibrated = fit(bound, calibrated.hypothesis, problem, parallel);
  const auto runs = simulate_all(bound, calibrated.hypothesis, training, bound.integration, parallel);
  bound.sizes = measure_sizes(bound, calibrated.hypothesis, training, runs);
  result.calibrated = calibrated.hypothesis;
  diagnosis.integration_order = bound.integration.order;
  diagnosis.integration_step = bound.integration.step;
  return result;
}

std::vector<surefoot::AttachedEffect> candidates(const Preparation& prepared, const surefoot::DiagnoseOptions& options,
                                                 const Parallel& parallel) {
  const BoundSimulator& bound = prepared.setup.bound;
  const Hypothesis& calibrated = prepared.calibrated;
  std::vector<surefoot::Effect> effects = surefoot::all_effects();
  for (const std::string& name : options.effects) {
    if (std::ranges::none_of(effects, [&](const auto& effect) { return effect.name == name; })) {
      throw surefoot::DiagnoseError("--effects: there is no effect called '" + name +
                                    "'; see surefoot/diagnose/effects/catalogue.hpp");
    }
  }
  std::erase_if(effects, [&](const surefoot::Effect& effect) {
    const bool asked =
        options.effects.empty() || std::ranges::find(options.effects, effect.name) != options.effects.end();
    return !asked || (prepared.setup.noise == NoiseKind::process && effect.place == surefoot::Place::output);
  });
  const auto& training = prepared.setup.split.training;
  const auto runs = simulate_all(bound, calibrated, training, bound.integration, parallel);
  return attachments(bound, effects, distinct_inputs(bound, calibrated, training, runs));
}

}  // namespace all_at_once
