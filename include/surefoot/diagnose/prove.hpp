// Proves a diagnosis on recordings that were used neither to fit nor to choose (they may veto, see confirm.hpp): errors
// before and after, against the noise and against a forest in place of physics.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/calibrate.hpp"
#include "surefoot/diagnose/forest_residual.hpp"
#include "surefoot/diagnose/investigation.hpp"
#include "surefoot/diagnose/mismatch.hpp"
#include "surefoot/diagnose/recording_error.hpp"

namespace surefoot::detail {

/// Executor on top of Parallel, for the forest.
struct ParallelExecutor {
  const Parallel* parallel;
  std::size_t width() const { return 1; }
  template <class Job>
  bool run(std::size_t count, Job&& job, std::stop_token = {}) const {
    (*parallel)(count, [&](std::size_t i) { job(i); });
    return true;
  }
};

/// Errors on the test recordings, of which both hypotheses need the initial states: whole recordings are simulated,
/// whatever the fit did.
inline void prove(Investigation& investigation, const Hypothesis& calibrated, const Hypothesis& chosen,
                  const Parallel& parallel, std::uint64_t seed) {
  const Rig& rig = investigation.rig;
  Diagnosis& diagnosis = investigation.diagnosis;
  const auto& training = investigation.split.training;
  const auto& test = investigation.split.test;
  Integration whole = rig.integration;
  whole.restart = 0;
  const Eigen::VectorXd scale = error_scale(rig);
  const Hypothesis nominal =
      with_estimated_starts(rig, investigation.nominal, test, investigation.problem.fit, parallel);
  const Hypothesis* models[3] = {&nominal, &calibrated, &chosen};
  std::vector<SimulatedRun> runs[3];
  for (int m = 0; m < 3; ++m) runs[m] = simulate_all(rig, *models[m], test, whole, parallel);

  std::vector<double> errors[3];
  for (std::size_t i = 0; i < test.size(); ++i) {
    for (int m = 0; m < 3; ++m) errors[m].push_back(recording_error(rig, test[i], runs[m][i], scale));
    diagnosis.per_recording.push_back({rig.recordings[test[i]].name, errors[1][i], errors[2][i]});
    diagnosis.curves.push_back({rig.recordings[test[i]].name, rig.recordings[test[i]].time,
                                rig.recordings[test[i]].inputs, rig.recordings[test[i]].outputs, runs[0][i].outputs,
                                runs[1][i].outputs, runs[2][i].outputs});
  }
  const std::vector<double> counts = cell_counts(rig, test);
  diagnosis.test_before = over_all(errors[1], counts);
  diagnosis.test_after = over_all(errors[2], counts);

  std::vector<double> trained[2];
  const auto before = simulate_all(rig, calibrated, training, whole, parallel);
  const auto after = simulate_all(rig, chosen, training, whole, parallel);
  for (std::size_t i = 0; i < training.size(); ++i) {
    trained[0].push_back(recording_error(rig, training[i], before[i], scale));
    trained[1].push_back(recording_error(rig, training[i], after[i], scale));
  }
  diagnosis.train_before = over_all(trained[0], cell_counts(rig, training));
  diagnosis.train_after = over_all(trained[1], cell_counts(rig, training));

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
        left.push_back(recording_error(rig, test[i], corrected(rig, test[i], simulated[i], model), scale));
      }
      return over_all(left, counts);
    };
    // A forest on the residuals of the calibrated model instead of effects.
    diagnosis.test_forest = corrected_error(runs[1], train_residual_model(rig, training, before, executor, seed));
    // And beside them, where they do not explain everything.
    if (diagnosis.verdict == Verdict::unexplained) {
      ForestResidual& offer = diagnosis.forest_residual;
      Weighting weighting = investigation.problem.fit.weighting;
      weighting.sigma = residual_sizes(rig, training, after);
      const Comparison unseen =
          cross_validate_residual(rig, training, after, investigation.split.folds, weighting, executor, seed);
      offer.tried = true;
      offer.gain = unseen.gain;
      offer.gain_stderr = unseen.stderr_;
      offer.model = train_residual_model(rig, training, after, executor, seed);
      offer.heldout_before = diagnosis.test_after;
      offer.heldout_after = corrected_error(runs[2], offer.model);
      offer.kept = unseen.gain > 0.03 && unseen.t > 2.5 && offer.heldout_after < offer.heldout_before;
    }
  }

  // By output.
  std::vector<Structure> structures;
  measure_mismatch(rig, training, simulate_all(rig, calibrated, training, rig.integration, parallel),
                   investigation.problem.fit.weighting.sigma, investigation.noise, &structures);
  double floor = 0;
  for (std::size_t k = 0; k < rig.info.outputs.size(); ++k) {
    const auto output = static_cast<Eigen::Index>(k);
    ChannelMismatch channel;
    channel.output = rig.info.outputs[k].name;
    channel.unit = rig.info.outputs[k].unit;
    double sums[3] = {}, count = 0;
    for (std::size_t i = 0; i < test.size(); ++i) {
      for (int m = 0; m < 3; ++m) sums[m] += series_of(rig, test[i], runs[m][i], output).squaredNorm();
      for (const Cell& cell : cells_of(rig.recordings[test[i]])) count += cell.output == output ? 1 : 0;
    }
    count = std::max(count, 1.0);
    channel.rmse_nominal = std::sqrt(sums[0] / count);
    channel.rmse_calibrated = std::sqrt(sums[1] / count);
    channel.rmse_after = std::sqrt(sums[2] / count);
    const double stated = rig.info.outputs[k].noise;
    channel.noise = stated > 0 ? stated : std::min(fast_noise(rig, training, output), channel.rmse_after);
    channel.p_value = structures[k].p_value;
    floor +=
        channel.noise * channel.noise / (scale[output] * scale[output]) / static_cast<double>(rig.info.outputs.size());
    diagnosis.channels.push_back(channel);
  }
  diagnosis.noise_floor = std::sqrt(floor);
}

}  // namespace surefoot::detail
