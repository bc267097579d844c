// Noise with known numbers, for the tests of what is said about noise.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/residual_tests/noise_model.hpp"

namespace toys {

/// Noise of an output that swings at up to 3 units per second.
inline surefoot::diagnosis::NoiseSeries noise_series(const surefoot::diagnosis::ResidualNoise& model, Eigen::Index rows,
                                                     double interval, std::uint64_t seed) {
  surefoot::Rng rng(seed, 0x6e6fu);
  surefoot::diagnosis::NoiseSeries series{Eigen::VectorXd::LinSpaced(rows, 0, interval * static_cast<double>(rows - 1)),
                                          Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
  const double kept = model.time > 0 ? std::exp(-interval / model.time) : 0;
  double slow = rng.normal();
  for (Eigen::Index i = 0; i < rows; ++i) {
    series.speed[i] = 3 * std::sin(0.3 * static_cast<double>(i) + static_cast<double>(seed % 7));
    if (i > 0) slow = kept * slow + std::sqrt(1 - kept * kept) * rng.normal();
    series.value[i] = std::hypot(model.rest, model.growth * series.speed[i]) *
                      (std::sqrt(model.share) * slow + std::sqrt(1 - model.share) * rng.normal());
  }
  return series;
}

inline std::vector<surefoot::diagnosis::NoiseSeries> noise_recordings(const surefoot::diagnosis::ResidualNoise& model,
                                                                      int count, Eigen::Index rows, double interval,
                                                                      std::uint64_t seed) {
  std::vector<surefoot::diagnosis::NoiseSeries> series;
  for (int i = 0; i < count; ++i) {
    series.push_back(noise_series(model, rows, interval, 1000 * seed + static_cast<std::uint64_t>(i)));
  }
  return series;
}

}  // namespace toys
