// Definitions of surefoot/diagnose/residual_tests/prediction_noise.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/residual_tests/noise_spectrum.hpp"
#include "surefoot/diagnose/residual_tests/prediction_noise.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"

namespace surefoot::diagnosis {

/// Noise of an output: its size as stated or as seen, and what it keeps from row to row.
SUREFOOT_ONCE FadingNoise noise_of_output(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                          const std::vector<SimulatedRun>& runs, Eigen::Index output) {
  FadingNoise noise = noise_from_spectrum(fast_spectrum(filled_series(bound, recordings, runs, output)));
  const bool stated = bound.info.outputs[static_cast<std::size_t>(output)].noise > 0;
  if (stated || !(noise.deviation > 0)) noise.deviation = noise_of(bound, recordings, output);
  return noise;
}

/// Adds noise to the readings of an output in recording r; the same whatever other recordings there are.
SUREFOOT_ONCE void add_noise(Eigen::MatrixXd& readings, Eigen::Index output, const FadingNoise& noise, std::size_t r) {
  Rng rng(static_cast<std::uint64_t>(output), static_cast<std::uint64_t>(r));
  const double renewed = noise.deviation * std::sqrt(1 - noise.rho * noise.rho);
  double off = noise.deviation * rng.normal();
  for (Eigen::Index row = 0; row < readings.cols(); ++row) {
    readings(output, row) += off;
    off = noise.rho * off + renewed * rng.normal();
  }
}

SUREFOOT_ONCE PredictionNoise prediction_noise(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                               const std::vector<std::size_t>& recordings, const Parallel& parallel) {
  if (!(bound.integration.follow > 0)) return {};
  const auto motion = simulate_all(bound, hypothesis, recordings, bound.integration, parallel);
  BoundSimulator trial = bound;
  std::vector<double> sizes;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(bound.info.outputs.size()); ++k) {
    const FadingNoise noise = noise_of_output(bound, recordings, motion, k);
    sizes.push_back(noise.deviation);
    for (const std::size_t r : recordings) add_noise(trial.recordings[r].outputs, k, noise, r);
  }
  const auto followed = simulate_all(trial, hypothesis, recordings, trial.integration, parallel);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!motion[i].finite || !followed[i].finite) return {};
    Eigen::MatrixXd& outputs = trial.recordings[recordings[i]].outputs;
    const double *read = bound.recordings[recordings[i]].outputs.data(), *moved = motion[i].outputs.data();
    for (Eigen::Index n = 0; n < outputs.size(); ++n) outputs.data()[n] += moved[n] - read[n];  // noise on the motion
  }
  PredictionNoise result;
  const Eigen::Index memory = memory_of(NoiseKind::measurement);
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const auto output = static_cast<Eigen::Index>(k);
    const WhitenessTest left = test_whiteness(trial, recordings, followed, output, memory, 10 * memory);
    result.amplification.push_back(sizes[k] > 0 ? std::max(1.0, left.rms / sizes[k]) : 1);
    result.structure.push_back(left.share * left.rms * left.rms);
  }
  return result;
}

SUREFOOT_ONCE bool is_refuted(const PredictionNoise& noise, const BoundSimulator& bound,
                              const std::vector<std::size_t>& recordings, const std::vector<SimulatedRun>& runs) {
  constexpr double largest_ratio = 1.5;  // of root mean squares: that of a verdict, the other way round
  const Eigen::Index memory = memory_of(NoiseKind::measurement);
  for (std::size_t k = 0; k < noise.amplification.size(); ++k) {
    const auto output = static_cast<Eigen::Index>(k);
    const double left = test_whiteness(bound, recordings, runs, output, memory, 10 * memory).rms;
    const double by_noise = noise.amplification[k] * noise_of(bound, recordings, output);
    if (noise.amplification[k] > 1 && largest_ratio * left < by_noise) return true;
  }
  return false;
}

}  // namespace surefoot::diagnosis
