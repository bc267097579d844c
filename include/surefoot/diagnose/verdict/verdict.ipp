// Definitions of surefoot/diagnose/verdict/verdict.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/residual_tests/locate.hpp"
#include "surefoot/diagnose/residual_tests/mismatch.hpp"
#include "surefoot/diagnose/residual_tests/noise.hpp"
#include "surefoot/diagnose/residual_tests/predictability.hpp"
#include "surefoot/diagnose/residual_tests/walking/sequence_residual.hpp"
#include "surefoot/diagnose/residual_tests/walking/slip_by_place.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE void locate(Investigation& investigation, const Hypothesis& calibrated, const Parallel& parallel,
                            std::uint64_t seed) {
  const BoundSimulator& bound = investigation.bound;
  if (investigation.noise == NoiseKind::final_pose) return;
  const auto& recordings = investigation.split.training;
  const auto trajectories = simulate_all(bound, calibrated, recordings, bound.integration, parallel);
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) rows += bound.recordings[r].rows();
  const FeatureTable table = make_features(bound, recordings, trajectories, std::max<Eigen::Index>(1, rows / 4000));
  const Eigen::Index horizon = investigation.noise == NoiseKind::process ? 0 : 10;
  const Eigen::VectorXd energy =
      mismatch_energy(bound, recordings, trajectories, investigation.problem.fit.weighting.sigma, table, horizon);
  investigation.diagnosis.regions = find_region(table, energy, 2, 60, seed);
  investigation.diagnosis.intervals = find_intervals(bound, recordings, table, energy, 6);
}

SUREFOOT_INLINE std::string names_of(const Hypothesis& hypothesis) {
  std::vector<std::string> names;
  for (const AttachedEffect& effect : hypothesis.effects) names.push_back(effect.effect->name);
  return in_list(names);
}

SUREFOOT_INLINE void conclude(Investigation& investigation, const std::vector<AttachedEffect>& candidates,
                              const Parallel& parallel, std::uint64_t seed) {
  Diagnosis& diagnosis = investigation.diagnosis;
  const BoundSimulator& bound = investigation.bound;
  const FitProblem& problem = investigation.problem.fit;
  Selection& selection = investigation.selection;
  const auto& training = investigation.split.training;
  // Unknown initial states of the test recordings are estimated for each model alike.
  const auto ready = [&](const Hypothesis& hypothesis) {
    return with_estimated_starts(bound, hypothesis, investigation.split.test, problem, parallel);
  };
  const Hypothesis calibrated = ready(selection.nominal.hypothesis);
  Hypothesis chosen = ready(selection.chosen.hypothesis);
  const std::size_t known = calibrated.effects.size();
  if (chosen.effects.size() > known && !confirmed(investigation, calibrated, chosen, parallel)) {
    chosen = calibrated;
    selection.alternatives.assign(1, selection.chosen);
    selection.chosen = selection.nominal;
    diagnosis.remarks.push_back({"",
                                 "effects that seemed to explain the mismatch did not lower the error on the test "
                                 "recordings, and were dropped"});
  }
  const bool found_any = chosen.effects.size() > known;
  diagnosis.integration_order = bound.integration.order;
  diagnosis.integration_step = bound.integration.step;

  // What is left before and after.
  const auto before = simulate_all(bound, calibrated, training, bound.integration, parallel);
  const auto after = simulate_all(bound, chosen, training, bound.integration, parallel);
  const Eigen::VectorXd& sigma = problem.weighting.sigma;
  Mismatch missing, left;
  if (investigation.noise != NoiseKind::final_pose) {
    missing = measure_mismatch(bound, training, before, sigma, investigation.noise);
    left = measure_mismatch(bound, training, after, sigma, investigation.noise);
  }
  const double still = missing.energy > 0 ? left.energy / missing.energy : 0;
  const double tolerated = found_any && investigation.noise != NoiseKind::process ? 0.3 : 0.12;
  bool open = left.p_value < 0.001 && left.share > tolerated && (!found_any || still > 0.2);
  if (found_any && investigation.noise == NoiseKind::measurement) {
    const Remainder rest = left_on_held_out(investigation, calibrated, chosen, parallel);
    open = open || (rest.share > 0.2 && rest.times > 3);
  }
  const auto& folds = investigation.problem.folds;
  if (investigation.noise == NoiseKind::final_pose) {
    open = sequence_structure(bound, chosen, problem, folds, parallel).p_value < 0.005;
  } else if (investigation.noise == NoiseKind::process) {
    const auto predicts = [](const Comparison& found) { return found.gain > 0.03 && found.p_value < 0.005; };
    open = open || predicts(residual_predictability(bound, chosen, problem, folds, parallel, seed)) ||
           predicts(slip_by_place(bound, chosen, problem, folds, parallel, seed));
  }
  if (open) {
    diagnosis.verdict = Verdict::unexplained;
  } else if (found_any) {
    diagnosis.verdict = Verdict::missing_physics;
  } else if (investigation.parameters_matter.gain > 0.02 && investigation.parameters_matter.t > 2) {
    diagnosis.verdict = Verdict::parameters_only;
  } else {
    diagnosis.verdict = Verdict::adequate;
  }

  const StandardErrors nominal_errors = standard_errors(bound, calibrated, problem, parallel);
  diagnosis.parameters = calibrated_parameters(bound, calibrated, nominal_errors);
  diagnosis.correlated = correlated_pairs(bound, nominal_errors);
  const StandardErrors errors = !found_any ? nominal_errors : standard_errors(bound, chosen, problem, parallel);
  diagnosis.augmented_parameters = calibrated_parameters(bound, chosen, errors);
  diagnosis.noise_sentence =
      investigation.noise == NoiseKind::measurement ? "noise of measurement: whole recordings are simulated"
      : investigation.noise == NoiseKind::process
          ? "noise of the process accumulates: each row is predicted from the one before"
          : "noise of the process accumulates until the final pose: poses are weighed by its covariance";

  for (std::size_t e = 0; e < chosen.effects.size(); ++e) {
    FoundEffect found = describe(bound, chosen, e, &errors);
    if (e < known) {
      diagnosis.known_effects.push_back(found);
      continue;
    }
    const Comparison evidence = e - known < selection.evidence.size() ? selection.evidence[e - known] : Comparison{};
    std::vector<EvaluatedHypothesis> rivals;
    for (const EvaluatedHypothesis& other : selection.alternatives) {
      if (other.hypothesis.effects.size() == chosen.effects.size()) rivals.push_back(other);
    }
    found.evidence = {evidence.gain, evidence.stderr_,
                      std::min(1.0, evidence.p_value * static_cast<double>(selection.candidates)),
                      bootstrap_confidence(selection.chosen, selection.nominal.heldout, rivals, seed)};
    diagnosis.effects.push_back(found);
  }

  // What might stand in their place.
  std::ranges::sort(selection.alternatives, [](const EvaluatedHypothesis& a, const EvaluatedHypothesis& b) {
    return a.heldout.total() < b.heldout.total();
  });
  std::vector<std::string> twins;
  const EvaluatedHypothesis* first_twin = nullptr;
  for (const EvaluatedHypothesis& other : selection.alternatives) {
    Alternative alternative;
    alternative.heldout_rmse = other.heldout.rms();
    for (const AttachedEffect& effect : other.hypothesis.effects)
      alternative.effects.emplace_back(effect.effect->name, effect.place);
    const bool same_names = std::all_of(
        other.hypothesis.effects.begin(), other.hypothesis.effects.end(), [&](const AttachedEffect& effect) {
          return std::any_of(chosen.effects.begin(), chosen.effects.end(), [&](const AttachedEffect& mine) {
            return mine.effect->name == effect.effect->name && mine.at == effect.at &&
                   mine.effect->place == effect.effect->place;
          });
        });
    if (same_names) continue;  // another form of the same
    const Comparison worse = compare_losses(other.heldout, selection.chosen.heldout);
    // Not clearly worse, or so close to what was gained that the form of either effect may account for the rest.
    const double ours = 1 - selection.chosen.heldout.rms() / selection.nominal.heldout.rms();
    const double theirs = 1 - other.heldout.rms() / selection.nominal.heldout.rms();
    const bool level = worse.gain < 0.1 && (worse.t < 2 || worse.gain < 0.01);
    alternative.indistinguishable = found_any && (level || theirs > 0.97 * ours);
    if (alternative.indistinguishable) {
      twins.push_back(names_of(other.hypothesis));
      if (first_twin == nullptr) first_twin = &other;
    }
    diagnosis.alternatives.push_back(alternative);
  }
  if (first_twin != nullptr) {
    const Effect& mine = *chosen.effects.back().effect;
    const Effect& other = *first_twin->hypothesis.effects.back().effect;
    diagnosis.next_experiment = mine.experiment + ": separates " + mine.name + " from " + other.name;
    if (!other.experiment.empty() && other.experiment != mine.experiment) {
      diagnosis.next_experiment += "; or " + other.experiment;
    }
  }

  locate(investigation, calibrated, parallel, seed);
  prove(investigation, calibrated, chosen, parallel, seed);

  if (!found_any && diagnosis.verdict != Verdict::unexplained) {
    FitProblem few = problem;
    few.recordings = investigation.problem.screened;
    for (const Proposal& proposal : propose(bound, calibrated, few, candidates, parallel)) {
      for (std::size_t k = 0; k < proposal.effect.effect->parameters.size() && proposal.visible > 0; ++k) {
        const EffectParameter& parameter = proposal.effect.effect->parameters[k];
        if (!parameter.strength) continue;
        diagnosis.limits.push_back({proposal.effect.effect->name,
                                    proposal.effect.place,
                                    {parameter.name, measure_unit(bound, proposal.effect, parameter.measure),
                                     std::abs(proposal.visible) * proposal.tried[static_cast<Eigen::Index>(k)], 0, 0}});
        break;
      }
    }
    std::ranges::sort(diagnosis.limits,
                      [](const DetectionLimit& a, const DetectionLimit& b) { return a.name < b.name; });
  }

  std::vector<std::string> sentences;
  for (const FoundEffect& effect : diagnosis.effects) sentences.push_back(effect.sentence);
  const std::string percent = in_digits(100 * (1 - diagnosis.test_after / std::max(diagnosis.test_before, 1e-300)));
  switch (diagnosis.verdict) {
    case Verdict::adequate:
      diagnosis.sentence = "Nothing is missing: with its nominal parameters the model agrees with the recordings.";
      break;
    case Verdict::parameters_only:
      diagnosis.sentence = "Nothing is missing: with calibrated parameters the model agrees with the recordings.";
      break;
    case Verdict::missing_physics:
      diagnosis.sentence = "Left out of the model: " + in_list(sentences) +
                           ". With that, the error on recordings kept aside falls by " + percent + " %.";
      break;
    case Verdict::unexplained:
      diagnosis.sentence = "The model leaves something out that no known effect explains";
      if (!sentences.empty()) diagnosis.sentence += "; a part of it: " + in_list(sentences);
      if (!diagnosis.regions.empty()) diagnosis.sentence += "; it shows where " + diagnosis.regions.front().rule;
      diagnosis.sentence += ".";
      break;
  }
  if (!twins.empty() && diagnosis.verdict == Verdict::missing_physics) {
    diagnosis.sentence += " These recordings cannot tell it from " + in_list(twins) + ".";
  }
  if (diagnosis.verdict != Verdict::unexplained) {
    diagnosis.noise_findings = find_noise(bound, chosen, training, investigation.noise, parallel);
  }
}

}  // namespace surefoot::diagnosis
