// Definitions of surefoot/diagnose/verdict/evaluate.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/diagnose/residual_tests/mismatch.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE void prove(Investigation& investigation, const Hypothesis& calibrated, const Hypothesis& chosen,
                           const Parallel& parallel, std::uint64_t seed) {
  const BoundSimulator& bound = investigation.bound;
  Diagnosis& diagnosis = investigation.diagnosis;
  const auto& training = investigation.split.training;
  const auto& test = investigation.split.test;
  Integration whole = bound.integration;
  whole.restart = 0;
  const Eigen::VectorXd scale = error_scale(bound);
  const Hypothesis nominal =
      with_estimated_starts(bound, investigation.nominal, test, investigation.problem.fit, parallel);
  const Hypothesis* models[3] = {&nominal, &calibrated, &chosen};
  std::vector<SimulatedRun> runs[3];
  for (int m = 0; m < 3; ++m) runs[m] = simulate_all(bound, *models[m], test, whole, parallel);

  std::vector<double> errors[3];
  for (std::size_t i = 0; i < test.size(); ++i) {
    for (int m = 0; m < 3; ++m) errors[m].push_back(recording_error(bound, test[i], runs[m][i], scale));
    diagnosis.per_recording.push_back({bound.recordings[test[i]].name, errors[1][i], errors[2][i]});
    diagnosis.curves.push_back({bound.recordings[test[i]].name, bound.recordings[test[i]].time,
                                bound.recordings[test[i]].inputs, bound.recordings[test[i]].outputs, runs[0][i].outputs,
                                runs[1][i].outputs, runs[2][i].outputs});
  }
  const std::vector<double> counts = cell_counts(bound, test);
  diagnosis.test_before = over_all(errors[1], counts);
  diagnosis.test_after = over_all(errors[2], counts);

  std::vector<double> trained[2];
  const auto before = simulate_all(bound, calibrated, training, whole, parallel);
  const auto after = simulate_all(bound, chosen, training, whole, parallel);
  for (std::size_t i = 0; i < training.size(); ++i) {
    trained[0].push_back(recording_error(bound, training[i], before[i], scale));
    trained[1].push_back(recording_error(bound, training[i], after[i], scale));
  }
  diagnosis.train_before = over_all(trained[0], cell_counts(bound, training));
  diagnosis.train_after = over_all(trained[1], cell_counts(bound, training));

  // 95 % interval of the ratio, over test recordings.
  Rng rng(seed, 0x7e57u);
  std::vector<double> ratios;
  for (int round = 0; round < 400; ++round) {
    double a = 0, b = 0;
    for (std::size_t i = 0; i < test.size(); ++i) {
      const std::size_t j = rng.below(static_cast<std::uint32_t>(test.size()));
      a += errors[1][j] * errors[1][j] * counts[j];
      b += errors[2][j] * errors[2][j] * counts[j];
    }
    ratios.push_back(a > 0 ? std::sqrt(b / a) : 1);
  }
  std::sort(ratios.begin(), ratios.end());
  diagnosis.gain_low = ratios[9];
  diagnosis.gain_high = ratios[389];

  if (investigation.noise != NoiseKind::final_pose) {
    const ParallelExecutor executor{&parallel};
    const auto corrected_error = [&](const std::vector<SimulatedRun>& simulated, const ResidualModel& model) {
      std::vector<double> left;
      for (std::size_t i = 0; i < test.size(); ++i) {
        left.push_back(recording_error(bound, test[i], corrected(bound, test[i], simulated[i], model), scale));
      }
      return over_all(left, counts);
    };
    // A forest on the residuals of the calibrated model instead of effects.
    diagnosis.test_forest = corrected_error(runs[1], train_residual_model(bound, training, before, executor, seed));
    // And beside them, where they do not explain everything.
    if (diagnosis.verdict == Verdict::unexplained) {
      ForestResidual& offer = diagnosis.forest_residual;
      Weighting weighting = investigation.problem.fit.weighting;
      weighting.sigma = residual_sizes(bound, training, after);
      const Comparison unseen =
          cross_validate_residual(bound, training, after, investigation.split.folds, weighting, executor, seed);
      offer.tried = true;
      offer.gain = unseen.gain;
      offer.gain_stderr = unseen.stderr_;
      offer.model = train_residual_model(bound, training, after, executor, seed);
      offer.heldout_before = diagnosis.test_after;
      offer.heldout_after = corrected_error(runs[2], offer.model);
      offer.kept = unseen.gain > 0.03 && unseen.t > 2.5 && offer.heldout_after < offer.heldout_before;
    }
  }

  // By output.
  std::vector<WhitenessTest> structures;
  measure_mismatch(bound, training, simulate_all(bound, calibrated, training, bound.integration, parallel),
                   investigation.problem.fit.weighting.sigma, investigation.noise, &structures);
  double floor = 0;
  for (std::size_t k = 0; k < bound.info.outputs.size(); ++k) {
    const auto output = static_cast<Eigen::Index>(k);
    ChannelMismatch channel;
    channel.output = bound.info.outputs[k].name;
    channel.unit = bound.info.outputs[k].unit;
    double sums[3] = {}, count = 0;
    for (std::size_t i = 0; i < test.size(); ++i) {
      for (int m = 0; m < 3; ++m) sums[m] += series_of(bound, test[i], runs[m][i], output).squaredNorm();
      for (const Cell& cell : cells_of(bound.recordings[test[i]])) count += cell.output == output ? 1 : 0;
    }
    count = std::max(count, 1.0);
    channel.rmse_nominal = std::sqrt(sums[0] / count);
    channel.rmse_calibrated = std::sqrt(sums[1] / count);
    channel.rmse_after = std::sqrt(sums[2] / count);
    const double stated = bound.info.outputs[k].noise;
    channel.noise = stated > 0 ? stated : std::min(fast_noise(bound, training, output), channel.rmse_after);
    channel.p_value = structures[k].p_value;
    floor += channel.noise * channel.noise / (scale[output] * scale[output]) /
             static_cast<double>(bound.info.outputs.size());
    diagnosis.channels.push_back(channel);
  }
  diagnosis.noise_floor = std::sqrt(floor);
}

}  // namespace surefoot::diagnosis
