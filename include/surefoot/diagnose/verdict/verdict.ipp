// Definitions of surefoot/diagnose/verdict/verdict.hpp.
#pragma once

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE bool is_unexplained(const VerdictEvidence& evidence, const VerdictCriteria& criteria) {
  if (evidence.noise == NoiseKind::final_pose) return evidence.sequence_p_value < criteria.sequence_significance;

  // Rows that are off by no more than was known of this machine: what can be predicted of that is no change.
  if (within_process_noise(evidence.process_ratio, criteria)) return false;

  const bool structured = evidence.structure_p_value < criteria.structure_significance &&
                          evidence.structure_share > criteria.tolerated_share &&
                          (!evidence.effects_found || evidence.structure_energy > criteria.tolerated_energy);
  if (structured) return true;

  if (evidence.noise == NoiseKind::measurement) {
    return evidence.noise_ratio > criteria.largest_ratio || evidence.recordings_beyond_noise > 0;
  }
  const auto predicts = [&](const PredictionEvidence& test) {
    return test.gain > criteria.predictable_gain && test.p_value < criteria.predictable_significance;
  };
  return predicts(evidence.prediction) || predicts(evidence.by_place);
}

SUREFOOT_ONCE Verdict decide(const VerdictEvidence& evidence, const VerdictCriteria& criteria) {
  if (!evidence.search_finished) return Verdict::unfinished;
  if (is_unexplained(evidence, criteria)) return Verdict::unexplained;
  if (evidence.effects_found) return Verdict::missing_physics;
  const bool parameters_matter =
      evidence.calibration_gain > criteria.calibration_gain && evidence.calibration_t > criteria.calibration_t;
  return parameters_matter ? Verdict::parameters_only : Verdict::adequate;
}

}  // namespace surefoot::diagnosis
