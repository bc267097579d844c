// Definitions of surefoot/diagnose/residual_tests/mismatch.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/mismatch.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Mismatch measure_mismatch(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                        const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                                        NoiseKind noise, const PredictionNoise& noise_of_predictions,
                                        std::vector<WhitenessTest>* by_output) {
  Mismatch result;
  for (Eigen::Index k = 0; k < sigma.size(); ++k) {
    const Eigen::Index memory = memory_of(noise);
    WhitenessTest structure = test_whiteness(bound, recordings, trajectories, k, memory, 10 * memory);
    const double square = structure.rms * structure.rms;
    if (!noise_of_predictions.structure.empty() && square > 0) {
      const double by_noise = noise_of_predictions.structure[static_cast<std::size_t>(k)] / square;
      structure.share = std::max(0.0, structure.share - by_noise);
    }
    if (by_output != nullptr) by_output->push_back(structure);
    result.energy += structure.share * square / (sigma[k] * sigma[k]);
    if (structure.p_value < 0.01) result.share = std::max(result.share, structure.share);
    result.p_value = std::min(result.p_value, structure.p_value * static_cast<double>(sigma.size()));
  }
  return result;
}

}  // namespace surefoot::diagnosis
