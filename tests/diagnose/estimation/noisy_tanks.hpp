// Tanks that leak, with noise, and the problem of fitting them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {

inline FitProblem problem_of(std::size_t recordings, double sigma) {
  FitProblem problem;
  for (std::size_t r = 0; r < recordings; ++r) problem.recordings.push_back(r);
  problem.weighting.sigma.setConstant(1, sigma);
  problem.max_iterations = 40;
  problem.tolerance = 1e-14;
  return problem;
}

// Tanks with these parameters [m/s, 1/s] and noise [m] that is correlated by `memory` from row to row.
inline std::vector<Recording> tanks(int count, Eigen::Index rows, double gain, double leak, double noise = 0,
                                    double memory = 0, std::uint64_t seed = 1) {
  std::vector<Recording> recordings;
  for (int r = 0; r < count; ++r) {
    Recording recording = toys::tank_recording(r, rows);
    recording.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({gain, leak}), recording).outputs;
    Rng rng(seed, static_cast<std::uint64_t>(r));
    double off = 0;
    for (double& level : recording.outputs.reshaped()) {
      off = memory * off + noise * std::sqrt(1 - memory * memory) * rng.normal();
      level += off;
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

}  // namespace surefoot::diagnosis
