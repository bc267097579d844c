// Definitions of surefoot/diagnose/residual_tests/forest_correction.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Eigen::MatrixXd residual_table(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
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

SUREFOOT_ONCE ResidualForest train_forest(const Dataset<Eigen::Dynamic, Eigen::Dynamic>& samples, int min_leaf,
                                          const Parallel& parallel, std::uint64_t seed) {
  ExtraTreesOptions options;
  options.trees = 40;
  options.min_leaf = min_leaf;
  return train_extra_trees(samples, options, ParallelExecutor{&parallel}, seed);
}

SUREFOOT_ONCE ResidualModel train_residual_model(const BoundSimulator& bound,
                                                 const std::vector<std::size_t>& recordings,
                                                 const std::vector<SimulatedRun>& runs, const Parallel& parallel,
                                                 std::uint64_t seed) {
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) rows += bound.recordings[r].rows();
  const FeatureTable table =
      make_features(bound, recordings, runs, std::max<Eigen::Index>(1, rows / 8000), InputsOf::row_before);
  ResidualModel model{table.names, {}, residual_sizes(bound, recordings, runs), {}};
  for (const OutputInfo& output : bound.info.outputs) model.outputs.push_back(output.name);
  for (double& size : model.scale) size = std::isfinite(size) ? size : 1;
  std::vector<Eigen::Index> measured;
  for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
    const Eigen::MatrixXd& outputs = bound.recordings[recordings[table.recording[static_cast<std::size_t>(j)]]].outputs;
    const Eigen::Index row = table.row[static_cast<std::size_t>(j)];
    bool any = false;
    for (Eigen::Index k = 0; k < outputs.rows(); ++k) any = any || std::isfinite(outputs(k, row));
    if (any) measured.push_back(j);
  }
  if (measured.empty()) return model;
  const Eigen::MatrixXd residuals = residual_table(bound, recordings, runs, model.scale, table);
  Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs.resize(table.values.rows(), static_cast<Eigen::Index>(measured.size()));
  samples.outputs.resize(residuals.rows(), samples.inputs.cols());
  for (Eigen::Index j = 0; j < samples.inputs.cols(); ++j) {
    const Eigen::Index from = measured[static_cast<std::size_t>(j)];
    for (Eigen::Index k = 0; k < samples.inputs.rows(); ++k) {
      samples.inputs(k, j) = single_precision(table.values(k, from));
    }
    for (Eigen::Index k = 0; k < residuals.rows(); ++k) samples.outputs(k, j) = residuals(k, from);
  }
  model.forest = train_forest(samples, std::max(5, static_cast<int>(measured.size() / 400)), parallel, seed);
  return model;
}

SUREFOOT_ONCE SimulatedRun corrected(const BoundSimulator& bound, std::size_t recording, const SimulatedRun& run,
                                     const ResidualModel& model) {
  if (model.forest.empty()) return run;
  if (model.outputs.size() != static_cast<std::size_t>(run.outputs.rows())) {
    throw DiagnoseError("the residual model has " + std::to_string(model.outputs.size()) +
                        " outputs, the simulator has " + std::to_string(run.outputs.rows()));
  }
  const FeatureTable table = make_features(bound, {recording}, {run}, 1, InputsOf::row_before);
  ResidualForest::Batch inputs(static_cast<Eigen::Index>(model.features.size()), run.outputs.cols());
  for (std::size_t k = 0; k < model.features.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const std::string& name = model.features[k];
    const auto found = std::find(table.names.begin(), table.names.end(), name);
    if (found != table.names.end()) {
      const auto from = static_cast<Eigen::Index>(found - table.names.begin());
      for (Eigen::Index j = 0; j < inputs.cols(); ++j) inputs(row, j) = single_precision(table.values(from, j));
    } else if (const auto& constants = bound.recordings[recording].constants; constants.contains(name)) {
      const auto constant = static_cast<float>(constants.at(name));
      for (Eigen::Index j = 0; j < inputs.cols(); ++j) inputs(row, j) = constant;
    } else {
      throw DiagnoseError(bound.recordings[recording].name + ": the residual model asks for '" + name +
                          "', which neither the simulator nor the recording has");
    }
  }
  ResidualForest::BatchOutput expected;
  model.forest.predict(inputs, expected);
  SimulatedRun result = run;
  for (Eigen::Index j = 0; j < expected.cols(); ++j) {
    for (Eigen::Index k = 0; k < expected.rows(); ++k) result.outputs(k, j) -= model.scale[k] * expected(k, j);
  }
  return result;
}

SUREFOOT_ONCE Comparison cross_validate_residual(const BoundSimulator& bound,
                                                 const std::vector<std::size_t>& recordings,
                                                 const std::vector<SimulatedRun>& runs,
                                                 const std::vector<std::vector<std::size_t>>& folds,
                                                 const Weighting& weighting, const Parallel& parallel,
                                                 std::uint64_t seed) {
  BlockLosses before, after;
  for (const std::vector<std::size_t>& fold : folds) {
    std::vector<std::size_t> held_out, others;  // places in the list of recordings
    for (std::size_t i = 0; i < recordings.size(); ++i) {
      const bool out = std::find(fold.begin(), fold.end(), recordings[i]) != fold.end();
      (out ? held_out : others).push_back(i);
    }
    if (others.empty()) return {};
    std::vector<std::size_t> learned;
    std::vector<SimulatedRun> learned_runs;
    for (const std::size_t i : others) {
      learned.push_back(recordings[i]);
      learned_runs.push_back(runs[i]);
    }
    const ResidualModel model = train_residual_model(bound, learned, learned_runs, parallel, seed);
    for (const std::size_t i : held_out) {
      const std::size_t r = recordings[i];
      const std::vector<Cell> cells = cells_of(bound.recordings[r]);
      append_losses(before, weighted_residuals(bound, r, runs[i], cells, weighting), weighting.robust);
      append_losses(after, weighted_residuals(bound, r, corrected(bound, r, runs[i], model), cells, weighting),
                    weighting.robust);
    }
  }
  return compare_losses(before, after);
}

}  // namespace surefoot::diagnosis
