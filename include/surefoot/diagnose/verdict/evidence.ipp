// Definitions of surefoot/diagnose/verdict/evidence.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/residuals.hpp"
#include "surefoot/diagnose/residual_tests/predictability.hpp"
#include "surefoot/diagnose/residual_tests/walking/sequence_residual.hpp"
#include "surefoot/diagnose/residual_tests/walking/slip_by_place.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/verdict/evidence.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double process_ratio(const std::vector<OutputInfo>& outputs, const Eigen::VectorXd& residuals) {
  double largest = 0;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const double by_chance = outputs[k].process_noise;
    if (!(by_chance > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double ratio = residuals[static_cast<Eigen::Index>(k)] / by_chance;
    largest = std::max(largest, ratio * ratio);
  }
  return largest;
}

SUREFOOT_ONCE void compare_with_process_noise(const EstimationSetup& setup,
                                              const std::vector<SimulatedRun>& training_runs,
                                              VerdictEvidence& evidence) {
  if (setup.noise != NoiseKind::process) return;
  const auto& outputs = setup.bound.info.outputs;
  evidence.process_ratio = process_ratio(outputs, residual_sizes(setup.bound, setup.split.training, training_runs));
  double cells = 0;
  for (const double count : cell_counts(setup.bound, setup.split.training)) cells += count;
  evidence.process_rows = cells / static_cast<double>(outputs.size());
}

SUREFOOT_ONCE VerdictEvidence gather_evidence(const EstimationSetup& setup, const FittedModels& models,
                                              const Diagnosis& diagnosis, const Comparison& calibration,
                                              const VerdictCriteria& verdict, const Parallel& parallel,
                                              std::uint64_t seed) {
  const auto& [nominal, calibrated, chosen] = models;
  const BoundSimulator& bound = setup.bound;
  const auto& folds = setup.split.folds;
  VerdictEvidence evidence;
  evidence.noise = setup.noise;
  evidence.effects_found = chosen.hypothesis.effects.size() > calibrated.hypothesis.effects.size();
  evidence.search_finished = diagnosis.complete;
  evidence.noise_ratio = diagnosis.noise_ratio;
  for (const RecordingFit& one : diagnosis.per_recording) evidence.recordings_beyond_noise += one.beyond_noise ? 1 : 0;
  evidence.calibration_gain = calibration.gain;
  evidence.calibration_t = calibration.t;
  if (setup.noise == NoiseKind::final_pose) {
    evidence.sequence_p_value = sequence_structure(bound, chosen.hypothesis, setup.problem, folds, parallel).p_value;
    return evidence;
  }
  compare_with_process_noise(setup, chosen.runs.training, evidence);
  evidence.structure_p_value = chosen.mismatch.p_value;
  evidence.structure_share = chosen.mismatch.share;
  const double before = calibrated.mismatch.energy;
  evidence.structure_energy = before > 0 ? chosen.mismatch.energy / before : 0;
  if (setup.noise == NoiseKind::measurement) return evidence;
  if (is_unexplained(evidence, verdict)) return evidence;
  const Comparison steps = residual_predictability(bound, chosen.hypothesis, setup.problem, folds, parallel, seed);
  evidence.prediction = {steps.gain, steps.p_value};
  if (is_unexplained(evidence, verdict)) return evidence;
  const Comparison places = slip_by_place(bound, chosen.hypothesis, setup.problem, folds, parallel, seed);
  evidence.by_place = {places.gain, places.p_value};
  return evidence;
}

SUREFOOT_ONCE void mark_beyond_noise(Diagnosis& diagnosis, const VerdictCriteria& verdict) {
  if (!std::isfinite(diagnosis.noise_ratio)) return;  // noise adds up on the way
  for (RecordingFit& one : diagnosis.per_recording) {
    const double ratio = one.fitted / diagnosis.noise_floor;
    // the mean square of n independent errors has the variance 2 / n
    const double excess = chi_square_score(ratio * ratio, 1, 2 / std::max(1.0, one.independent));
    one.beyond_noise = ratio > verdict.largest_ratio && excess > verdict.recording_excess;
  }
}

}  // namespace surefoot::diagnosis
