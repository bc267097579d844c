// The verdict: a decision on plain numbers.
#pragma once

#include <limits>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"

namespace surefoot::diagnosis {

/// Limits beyond which something is said to be left unexplained, or parameters to matter. Shares are of squared
/// residuals, gains of the root mean square error.
struct VerdictCriteria {
  // Residuals of the training recordings hold what noise does not:
  double structure_significance = 0.001;  // of the residuals' structure; small, as any model is wrong a little
  double tolerated_share = 0.12;          // that may stay without a name: too little to be worth a parameter
  double tolerated_energy = 0.05;         // beside effects, of what there was: other formulas of them leave a hundredth

  // Errors on held-out recordings against the noise (whole recordings only):
  double largest_ratio = 1.5;   // root mean square in units of the noise floor: beyond, something else is there
  double recording_excess = 4;  // standard deviations that noise gives its mean square, for a single recording

  // Tests for walks:
  double sequence_significance = 0.005;     // of final poses that go together
  double predictable_significance = 0.005;  // of errors of single steps that can be predicted
  double predictable_gain = 0.03;           // as much as an effect must gain, see SelectionCriteria

  double process_excess = 0.12;   // of the mean square of the stated process noise; as tolerated_share
  double process_deviations = 3;  // of the lower bound of a mean square, so that chance rarely is beyond that

  // Calibration changes the model:
  double calibration_gain = 0.02;  // below, the nominal parameters do as well
  double calibration_t = 2;        // in standard errors
};

/// A test of whether errors can be predicted.
struct PredictionEvidence {
  double gain = 0;  // share of the error that goes
  double p_value = 1;
};

/// All that a verdict depends on. Tests that were not made keep the values that say nothing.
struct VerdictEvidence {
  NoiseKind noise = NoiseKind::measurement;
  bool effects_found = false;

  double structure_p_value = 1;  // that the chosen model's residuals are noise
  double structure_share = 0;    // of the mean square of the output that shows it most
  double structure_energy = 0;   // against that of the calibrated model (ratio)

  bool search_finished = true;
  double noise_ratio = std::numeric_limits<double>::quiet_NaN();  // as in Diagnosis
  int recordings_beyond_noise = 0;

  /// Lower bound of the mean square of single rows' errors, over that of the stated process noise; of the output where
  /// it is largest. NaN where none is stated or noise does not accumulate.
  double process_ratio = std::numeric_limits<double>::quiet_NaN();

  double sequence_p_value = 1;
  PredictionEvidence prediction;  // of errors of single steps, from the motion
  PredictionEvidence by_place;    // of the same, from where they were made

  double calibration_gain = 0;
  double calibration_t = 0;
};

/// Whether rows are off by no more than the stated process noise: VerdictEvidence::process_ratio; NaN: no.
inline bool within_process_noise(double process_ratio, const VerdictCriteria& criteria) {
  return process_ratio <= 1 + criteria.process_excess;
}

/// Whether the chosen model leaves more than noise.
bool is_unexplained(const VerdictEvidence& evidence, const VerdictCriteria& criteria);

Verdict decide(const VerdictEvidence& evidence, const VerdictCriteria& criteria);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/verdict.ipp"
#endif
