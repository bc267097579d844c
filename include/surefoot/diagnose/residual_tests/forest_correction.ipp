// Definitions of surefoot/diagnose/residual_tests/forest_correction.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Eigen::MatrixXd residual_table(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                               const std::vector<SimulatedRun>& trajectories,
                                               const Eigen::VectorXd& sigma, const FeatureTable& table, double limit) {
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(sigma.size(), table.values.cols());
  for (Eigen::Index j = 0; j < residuals.cols(); ++j) {
    const std::size_t i = table.recording[static_cast<std::size_t>(j)];
    const Eigen::Index row = table.row[static_cast<std::size_t>(j)];
    for (Eigen::Index k = 0; k < sigma.size(); ++k) {
      double off = trajectories[i].outputs(k, row) - bound.recordings[recordings[i]].outputs(k, row);
      if (bound.wrapped[static_cast<std::size_t>(k)]) off = wrap_angle(off);
      if (std::isfinite(off)) residuals(k, j) = std::clamp(off / sigma[k], -limit, limit);
    }
  }
  return residuals;
}

SUREFOOT_INLINE SimulatedRun corrected(const BoundSimulator& bound, std::size_t recording, const SimulatedRun& run,
                                       const ResidualModel& model) {
  if (model.forest.empty()) return run;
  if (model.outputs.size() != static_cast<std::size_t>(run.outputs.rows())) {
    throw DiagnoseError("the residual model has " + std::to_string(model.outputs.size()) +
                        " outputs, the simulator has " + std::to_string(run.outputs.rows()));
  }
  const FeatureTable table = make_features(bound, {recording}, {run}, 1);
  ResidualForest::Batch inputs(static_cast<Eigen::Index>(model.features.size()), run.outputs.cols());
  for (std::size_t k = 0; k < model.features.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const std::string& name = model.features[k];
    const auto found = std::find(table.names.begin(), table.names.end(), name);
    if (found != table.names.end()) {
      inputs.row(row) = single_precision(table.values.row(found - table.names.begin()));
    } else if (const auto& constants = bound.recordings[recording].constants; constants.contains(name)) {
      inputs.row(row).setConstant(static_cast<float>(constants.at(name)));
    } else {
      throw DiagnoseError(bound.recordings[recording].name + ": the residual model asks for '" + name +
                          "', which neither the simulator nor the recording has");
    }
  }
  ResidualForest::BatchOutput expected;
  model.forest.predict(inputs, expected);
  SimulatedRun result = run;
  result.outputs -= model.scale.asDiagonal() * expected;
  return result;
}

}  // namespace surefoot::diagnosis
