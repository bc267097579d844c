// Definitions of surefoot/diagnose/simulation/bound_simulator.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/simulation/bound_simulator.hpp"
#include "surefoot/diagnose/simulation/simulation_run.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE double root_mean_square(const Eigen::VectorXd& values) {
  double sum = 0;
  Eigen::Index count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

SUREFOOT_INLINE double standard_deviation(const Eigen::VectorXd& values) {
  double sum = 0, squares = 0;
  Eigen::Index count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  if (count < 2) return 0;
  const double mean = sum / static_cast<double>(count);
  return std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean * mean));
}

SUREFOOT_ONCE std::vector<std::size_t> all_recordings(const BoundSimulator& bound) {
  std::vector<std::size_t> all(bound.recordings.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

SUREFOOT_ONCE Eigen::VectorXd nominal_parameters(const SimulatorInfo& info) {
  Eigen::VectorXd p(static_cast<Eigen::Index>(info.parameters.size()));
  for (std::size_t i = 0; i < info.parameters.size(); ++i) p[static_cast<Eigen::Index>(i)] = info.parameters[i].value;
  return p;
}

SUREFOOT_ONCE BoundSimulator without_functions(SimulatorInfo info, SimulatorStructure structure,
                                               std::vector<Recording> recordings) {
  constexpr double half_turn = 3.1416;  // [rad] rounded up: readings beyond it are of an angle that counts turns
  BoundSimulator bound;
  bound.info = std::move(info);
  bound.structure = std::move(structure);
  bound.sizes = unit_sizes(bound.info);
  bound.recordings = std::move(recordings);
  for (std::size_t k = 0; k < bound.info.outputs.size(); ++k) {
    bool wrapped = bound.info.outputs[k].unit == "rad";
    for (const Recording& recording : bound.recordings) {
      for (Eigen::Index row = 0; row < recording.outputs.cols(); ++row) {
        wrapped = wrapped && !(std::abs(recording.outputs(static_cast<Eigen::Index>(k), row)) > half_turn);
      }
    }
    bound.wrapped.push_back(wrapped);
  }
  return bound;
}

}  // namespace surefoot::diagnosis
