// Definitions of surefoot/diagnose/verdict/evaluate.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::pair<double, double> ratio_interval(const std::vector<double>& before,
                                                       const std::vector<double>& after,
                                                       const std::vector<double>& counts, std::uint64_t seed,
                                                       const EvaluationCriteria& criteria) {
  Rng rng(seed, 0x7e57u);
  std::vector<double> ratios;
  for (std::uint32_t round = 0; round < criteria.rounds; ++round) {
    double a = 0, b = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const std::size_t j = rng.below(static_cast<std::uint32_t>(before.size()));
      a += before[j] * before[j] * counts[j];
      b += after[j] * after[j] * counts[j];
    }
    ratios.push_back(a > 0 ? std::sqrt(b / a) : 1);
  }
  std::sort(ratios.begin(), ratios.end());
  return {ratios[criteria.tail - 1], ratios[criteria.rounds - criteria.tail - 1]};
}

SUREFOOT_ONCE bool forest_helps(const Comparison& cross_validated, double held_out_before, double held_out_after,
                                const EvaluationCriteria& criteria) {
  return cross_validated.gain > criteria.min_forest_gain && cross_validated.t > criteria.min_forest_t &&
         held_out_after < held_out_before;
}

SUREFOOT_ONCE double corrected_error(const EstimationSetup& setup, const FittedModel& model, const Parallel& parallel,
                                     std::uint64_t seed) {
  const auto& [training, held_out, folds, cross_fitted] = setup.split;
  std::vector<SimulatedRun> runs(held_out.size());
  const auto correct = [&](const std::vector<std::size_t>& learned_from,
                           const std::vector<std::size_t>& corrected_ones) {
    std::vector<SimulatedRun> learned;
    for (const std::size_t r : learned_from) {
      const auto place = std::find(training.begin(), training.end(), r) - training.begin();
      learned.push_back(model.runs.whole_training[static_cast<std::size_t>(place)]);
    }
    const ResidualModel forest = train_residual_model(setup.bound, learned_from, learned, parallel, seed);
    for (const std::size_t r : corrected_ones) {
      const auto place = static_cast<std::size_t>(std::find(held_out.begin(), held_out.end(), r) - held_out.begin());
      runs[place] = corrected(setup.bound, r, model.runs.whole_held_out[place], forest);
    }
  };
  if (!cross_fitted) correct(training, held_out);
  for (std::size_t k = 0; cross_fitted && k < folds.size(); ++k) {
    std::vector<std::size_t> others;
    for (const std::size_t r : training) {
      if (std::find(folds[k].begin(), folds[k].end(), r) == folds[k].end()) others.push_back(r);
    }
    correct(others, folds[k]);
  }
  return error_over_all(setup.bound, held_out, runs);
}

SUREFOOT_ONCE ForestResidual offer_forest(const EstimationSetup& setup, const FittedModel& chosen,
                                          double held_out_before, const Parallel& parallel, std::uint64_t seed,
                                          const EvaluationCriteria& criteria) {
  const auto& training = setup.split.training;
  const std::vector<SimulatedRun>& runs = chosen.runs.whole_training;
  Weighting weighting = setup.problem.weighting;
  weighting.sigma = residual_sizes(setup.bound, training, runs);
  const Comparison unseen =
      cross_validate_residual(setup.bound, training, runs, setup.split.folds, weighting, parallel, seed);
  ForestResidual offer;
  offer.tried = true;
  offer.gain = unseen.gain;
  offer.gain_stderr = unseen.stderr_;
  offer.model = train_residual_model(setup.bound, training, runs, parallel, seed);
  offer.held_out_before = held_out_before;
  offer.held_out_after = corrected_error(setup, chosen, parallel, seed);
  offer.kept = forest_helps(unseen, offer.held_out_before, offer.held_out_after, criteria);
  return offer;
}

SUREFOOT_ONCE double output_noise(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                  Eigen::Index output, const WhitenessTest& residuals, const FastSpectrum& spectrum,
                                  double error) {
  constexpr double significance = 0.01;  // of structure in the residuals
  constexpr double of_a_step = 1 / 3.4641;  // the deviation of what is anywhere in it, 1 / sqrt(12)
  constexpr double remembering = 4;  // times as large as what differs from row to row: noise of which 0.9 remains
  const double stated = bound.info.outputs[static_cast<std::size_t>(output)].noise;
  if (stated > 0) return stated;
  const FadingNoise noise = noise_from_spectrum(spectrum);
  const bool lasting = residuals.p_value < significance;
  const bool told = noise.deviation > 0 && (lasting || !noise.slow);  // few rows tell one memory from another badly
  if (told) return std::min(std::max(noise.deviation, of_a_step * resolution(bound, recordings, output)), error);
  const double structured = lasting ? residuals.predicted : 0;
  const double unpredictable = residuals.typical * std::sqrt(1 - structured);
  const double fast = fast_noise(bound, recordings, output);
  const double most = fast > 0 ? remembering * fast : unpredictable;  // 0: a coarse sensor that rarely moves
  return std::min(std::max(fast, std::min(unpredictable, most)), error);
}

/// The same where noise adds up from row to row: as stated, or as far as it is fast.
SUREFOOT_ONCE double noise_of_steps(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                    Eigen::Index output, double error) {
  const double stated = bound.info.outputs[static_cast<std::size_t>(output)].noise;
  return stated > 0 ? stated : std::min(fast_noise(bound, recordings, output), error);
}

SUREFOOT_ONCE std::vector<ChannelMismatch> mismatch_by_output(const EstimationSetup& setup,
                                                              const FittedModels& models) {
  const BoundSimulator& bound = setup.bound;
  const auto& held_out = setup.split.held_out;
  const std::array all = {&models.nominal, &models.calibrated, &models.chosen};
  std::vector<ChannelMismatch> result;
  for (std::size_t k = 0; k < bound.info.outputs.size(); ++k) {
    const auto output = static_cast<Eigen::Index>(k);
    ChannelMismatch channel;
    channel.output = bound.info.outputs[k].name;
    channel.unit = bound.info.outputs[k].unit;
    std::array<double, all.size()> sums = {};
    double count = 0;
    for (std::size_t i = 0; i < held_out.size(); ++i) {
      for (std::size_t m = 0; m < all.size(); ++m) {
        const SimulatedRun& run = all[m]->runs.whole_held_out[i];
        sums[m] += surefoot::detail::sum_of_squares(series_of(bound, held_out[i], run, output));
      }
      for (const Cell& cell : cells_of(bound.recordings[held_out[i]])) count += cell.output == output ? 1 : 0;
    }
    count = std::max(count, 1.0);
    channel.rmse_nominal = std::sqrt(sums[0] / count);
    channel.rmse_calibrated = std::sqrt(sums[1] / count);
    channel.rmse_after = std::sqrt(sums[2] / count);
    channel.noise_stated = bound.info.outputs[k].noise > 0;
    const auto& training = setup.split.training;
    if (setup.noise == NoiseKind::measurement) {
      FastSpectrum left;
      if (!channel.noise_stated) {
        left = fast_spectrum(filled_series(bound, training, models.chosen.runs.training, output));
      }
      channel.noise = output_noise(bound, training, output, models.chosen.by_output[k], left, channel.rmse_after);
      channel.noise_amplification = amplification_of(setup.noise_of_predictions, k);
    } else {
      channel.noise = noise_of_steps(bound, training, output, channel.rmse_after);
    }
    channel.p_value = models.calibrated.by_output[k].p_value;
    result.push_back(std::move(channel));
  }
  return result;
}

/// Error that noise alone leaves of an output.
SUREFOOT_ONCE double left_by_noise(const ChannelMismatch& one) { return one.noise * one.noise_amplification; }

SUREFOOT_ONCE double noise_floor(const std::vector<ChannelMismatch>& outputs, const Eigen::VectorXd& scale) {
  double squares = 0;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (!(outputs[k].noise > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double unit = scale[static_cast<Eigen::Index>(k)];
    const double left = left_by_noise(outputs[k]) / unit;
    squares += left * left / static_cast<double>(outputs.size());
  }
  return std::sqrt(squares);
}

SUREFOOT_ONCE double noise_ratio(const std::vector<ChannelMismatch>& outputs) {
  double squares = 0;
  for (const ChannelMismatch& one : outputs) {
    const double ratio = one.noise > 0 ? one.rmse_after / left_by_noise(one) : std::numeric_limits<double>::quiet_NaN();
    squares += ratio * ratio / static_cast<double>(outputs.size());
  }
  return std::sqrt(squares);
}

SUREFOOT_ONCE void cap_noise(Diagnosis& diagnosis, double least, const Eigen::VectorXd& scale) {
  if (!(least < diagnosis.noise_floor) || !std::isfinite(diagnosis.noise_ratio)) return;
  double stated = 0, estimated = 0;
  const auto outputs = static_cast<double>(diagnosis.channels.size());
  for (std::size_t k = 0; k < diagnosis.channels.size(); ++k) {
    const ChannelMismatch& one = diagnosis.channels[k];
    const double noise = left_by_noise(one) / scale[static_cast<Eigen::Index>(k)];
    (one.noise_stated ? stated : estimated) += noise * noise / outputs;
  }
  const double left = least * least - stated;
  if (!(estimated > 0 && left > 0)) return;
  for (ChannelMismatch& one : diagnosis.channels) {
    if (!one.noise_stated) one.noise *= std::sqrt(left / estimated);
  }
  diagnosis.noise_floor = noise_floor(diagnosis.channels, scale);
  diagnosis.noise_ratio = noise_ratio(diagnosis.channels);
}

/// Values of the held-out errors of a recording that are independent of each other.
SUREFOOT_ONCE double independent_errors(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run) {
  double count = 0;
  for (std::size_t k = 0; k < bound.info.outputs.size(); ++k) {
    const Eigen::VectorXd series = series_of(bound, r, run, static_cast<Eigen::Index>(k));
    double measured = 0;
    for (const double value : series) measured += value != 0 ? 1 : 0;
    count += measured / autocorrelation_time({series});
  }
  return count;
}

/// Recordings whose curves are kept for pictures: all if they are few.
SUREFOOT_ONCE void keep_curves(const EstimationSetup& setup, const FittedModels& models, Diagnosis& diagnosis,
                               std::size_t most) {
  const auto& held_out = setup.split.held_out;
  for (std::size_t n = 0; n < std::min(most, held_out.size()); ++n) {
    const std::size_t i = held_out.size() <= most ? n : n * held_out.size() / most;
    const Recording& one = setup.bound.recordings[held_out[i]];
    diagnosis.curves.push_back(
        {one.name, one.time, one.inputs, one.outputs, models.nominal.runs.whole_held_out[i].outputs,
         models.calibrated.runs.whole_held_out[i].outputs, models.chosen.runs.whole_held_out[i].outputs});
  }
}

SUREFOOT_ONCE void evaluate_errors(const EstimationSetup& setup, const FittedModels& models, Diagnosis& diagnosis,
                                   std::uint64_t seed, const EvaluationCriteria& criteria) {
  const BoundSimulator& bound = setup.bound;
  const auto& [nominal, calibrated, chosen] = models;
  const auto &held_out = setup.split.held_out, &training = setup.split.training;
  const Eigen::VectorXd scale = error_scale(bound);
  const std::vector<double> before = recording_errors(bound, held_out, calibrated.runs.whole_held_out, scale);
  const std::vector<double> after = recording_errors(bound, held_out, chosen.runs.whole_held_out, scale);
  // that parameters fitted to the others are a little off for one recording is no missing physics
  const auto& runs = setup.split.cross_fitted ? chosen.runs.whole_training : chosen.runs.whole_held_out;
  const std::vector<double> fitted = recording_errors(bound, held_out, runs, scale);
  for (std::size_t i = 0; i < held_out.size(); ++i) {
    diagnosis.per_recording.push_back({bound.recordings[held_out[i]].name, before[i], after[i], fitted[i],
                                       independent_errors(bound, held_out[i], runs[i])});
  }
  keep_curves(setup, models, diagnosis, criteria.curves);
  const std::vector<double> counts = cell_counts(bound, held_out);
  diagnosis.held_out_before = over_all(before, counts);
  diagnosis.held_out_after = over_all(after, counts);
  diagnosis.training_before = error_over_all(bound, training, calibrated.runs.whole_training);
  diagnosis.training_after = error_over_all(bound, training, chosen.runs.whole_training);
  const auto [low, high] = ratio_interval(before, after, counts, seed, criteria);
  diagnosis.gain_low = low;
  diagnosis.gain_high = high;
  diagnosis.channels = mismatch_by_output(setup, models);
  diagnosis.noise_floor = noise_floor(diagnosis.channels, scale);
  if (setup.noise != NoiseKind::measurement || !(diagnosis.noise_floor > 0)) return;  // noise adds up on the way
  diagnosis.noise_ratio = noise_ratio(diagnosis.channels);
}

SUREFOOT_ONCE void offer_forests(const EstimationSetup& setup, const FittedModels& models, Diagnosis& diagnosis,
                                 const Parallel& parallel, std::uint64_t seed, const EvaluationCriteria& criteria) {
  if (setup.noise == NoiseKind::final_pose || diagnosis.verdict != Verdict::unexplained) return;
  diagnosis.forest_residual = offer_forest(setup, models.chosen, diagnosis.held_out_after, parallel, seed, criteria);
}

}  // namespace surefoot::diagnosis
