// Share of what a model misses that is not noise: residual structure over all outputs.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/prediction_noise.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"

namespace surefoot::diagnosis {

/// How much of the mean square that is not noise, over all outputs in units of sigma.
struct Mismatch {
  double energy = 0;   // sum over outputs of share * mean square / sigma^2
  double share = 0;    // largest over outputs
  double p_value = 1;  // smallest over outputs, corrected for their number
};

/// Of simulations that follow the readings, beyond what noise alone leaves of these.
Mismatch measure_mismatch(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                          const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma, NoiseKind noise,
                          const PredictionNoise& noise_of_predictions = {},
                          std::vector<WhitenessTest>* by_output = nullptr);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/mismatch.ipp"
#endif
