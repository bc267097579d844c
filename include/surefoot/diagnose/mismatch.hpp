// How much of what a model misses is not noise: residual structure over all outputs.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/detect.hpp"
#include "surefoot/diagnose/process_noise.hpp"

namespace surefoot {

/// How much of the mean square that is not noise, over all outputs in units of sigma.
struct Mismatch {
  double energy = 0;   // sum over outputs of share * mean square / sigma^2
  double share = 0;    // largest over outputs
  double p_value = 1;  // smallest over outputs, corrected for their number
};

inline Mismatch measure_mismatch(const Rig& rig, const std::vector<std::size_t>& recordings,
                                 const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                                 NoiseKind noise, std::vector<Structure>* by_output = nullptr) {
  Mismatch result;
  for (Eigen::Index k = 0; k < sigma.size(); ++k) {
    const Eigen::Index memory = memory_of(noise);
    const Structure structure = residual_structure(rig, recordings, trajectories, k, memory, 10 * memory);
    if (by_output != nullptr) by_output->push_back(structure);
    result.energy += structure.share * structure.rms * structure.rms / (sigma[k] * sigma[k]);
    if (structure.p_value < 0.01) result.share = std::max(result.share, structure.share);
    result.p_value = std::min(result.p_value, structure.p_value * static_cast<double>(sigma.size()));
  }
  return result;
}

}  // namespace surefoot
