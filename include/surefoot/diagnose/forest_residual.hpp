// A forest in place of physics: learns from features of the simulated motion what a simulator leaves of its outputs,
// and takes it off. Whole recordings are simulated, so that it needs nothing measured. It is the yardstick for effects,
// and what is offered where none explains a mismatch.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/diagnose/features.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/diagnose/score.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot {

/// Residuals of the table's samples, in units of sigma, cut off at `limit`; 0 where nothing was measured.
inline Eigen::MatrixXd residual_table(const Rig& rig, const std::vector<std::size_t>& recordings,
                                      const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                                      const FeatureTable& table, double limit = 10) {
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(sigma.size(), table.values.cols());
  for (Eigen::Index j = 0; j < residuals.cols(); ++j) {
    const std::size_t i = table.recording[static_cast<std::size_t>(j)];
    const Eigen::Index row = table.row[static_cast<std::size_t>(j)];
    for (Eigen::Index k = 0; k < sigma.size(); ++k) {
      double off = trajectories[i].outputs(k, row) - rig.recordings[recordings[i]].outputs(k, row);
      if (rig.wrapped[static_cast<std::size_t>(k)]) off = wrap_angle(off);
      if (std::isfinite(off)) residuals(k, j) = std::clamp(off / sigma[k], -limit, limit);
    }
  }
  return residuals;
}

namespace detail {

inline Eigen::MatrixXf single_precision(const Eigen::MatrixXd& values) {
  return values.cwiseMax(-1e30).cwiseMin(1e30).cast<float>();
}

}  // namespace detail

/// Learns from at most about 8000 rows in which something was measured. `runs` are whole simulations.
template <Executor E>
ResidualModel train_residual_model(const Rig& rig, const std::vector<std::size_t>& recordings,
                                   const std::vector<SimulatedRun>& runs, const E& executor, std::uint64_t seed) {
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) rows += rig.recordings[r].rows();
  const FeatureTable table = make_features(rig, recordings, runs, std::max<Eigen::Index>(1, rows / 8000));
  ResidualModel model{table.names, {}, residual_sizes(rig, recordings, runs), {}};
  for (const OutputInfo& output : rig.info.outputs) model.outputs.push_back(output.name);
  model.scale = model.scale.unaryExpr([](double size) { return std::isfinite(size) ? size : 1; });
  std::vector<Eigen::Index> measured;
  for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
    const Recording& recording = rig.recordings[recordings[table.recording[static_cast<std::size_t>(j)]]];
    if (recording.outputs.col(table.row[static_cast<std::size_t>(j)]).array().isFinite().any()) measured.push_back(j);
  }
  if (measured.empty()) return model;
  Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs = detail::single_precision(table.values(Eigen::all, measured));
  samples.outputs = residual_table(rig, recordings, runs, model.scale, table)(Eigen::all, measured);
  ExtraTreesOptions options;
  options.trees = 40;
  options.min_leaf = std::max(5, static_cast<int>(measured.size() / 400));
  model.forest = train_extra_trees(samples, options, executor, seed);
  return model;
}

/// A simulated recording of the rig with what the model expects taken off its outputs. Throws DiagnoseError if the
/// model asks for a feature that the simulator and the recording do not have.
inline SimulatedRun corrected(const Rig& rig, std::size_t recording, const SimulatedRun& run,
                              const ResidualModel& model) {
  if (model.forest.empty()) return run;
  if (model.outputs.size() != static_cast<std::size_t>(run.outputs.rows())) {
    throw DiagnoseError("the residual model has " + std::to_string(model.outputs.size()) +
                        " outputs, the simulator has " + std::to_string(run.outputs.rows()));
  }
  const FeatureTable table = make_features(rig, {recording}, {run}, 1);
  ResidualForest::Batch inputs(static_cast<Eigen::Index>(model.features.size()), run.outputs.cols());
  for (std::size_t k = 0; k < model.features.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const std::string& name = model.features[k];
    const auto found = std::find(table.names.begin(), table.names.end(), name);
    if (found != table.names.end()) {
      inputs.row(row) = detail::single_precision(table.values.row(found - table.names.begin()));
    } else if (const auto& constants = rig.recordings[recording].constants; constants.contains(name)) {
      inputs.row(row).setConstant(static_cast<float>(constants.at(name)));
    } else {
      throw DiagnoseError(rig.recordings[recording].name + ": the residual model asks for '" + name +
                          "', which neither the simulator nor the recording has");
    }
  }
  ResidualForest::BatchOutput expected;
  model.forest.predict(inputs, expected);
  SimulatedRun result = run;
  result.outputs -= model.scale.asDiagonal() * expected;
  return result;
}

/// What the forest gains in simulations of recordings it has not seen: each fold is corrected by a model of the others.
/// `runs` go with `recordings`.
template <Executor E>
Comparison cross_validate_residual(const Rig& rig, const std::vector<std::size_t>& recordings,
                                   const std::vector<SimulatedRun>& runs,
                                   const std::vector<std::vector<std::size_t>>& folds, const Weighting& weighting,
                                   const E& executor, std::uint64_t seed) {
  Score before, after;
  for (const std::vector<std::size_t>& fold : folds) {
    std::vector<std::size_t> others, held;  // places in the list of recordings
    for (std::size_t i = 0; i < recordings.size(); ++i) {
      const bool out = std::find(fold.begin(), fold.end(), recordings[i]) != fold.end();
      (out ? held : others).push_back(i);
    }
    if (others.empty()) return {};
    std::vector<std::size_t> learned;
    std::vector<SimulatedRun> learned_runs;
    for (const std::size_t i : others) {
      learned.push_back(recordings[i]);
      learned_runs.push_back(runs[i]);
    }
    const ResidualModel model = train_residual_model(rig, learned, learned_runs, executor, seed);
    for (const std::size_t i : held) {
      const std::size_t r = recordings[i];
      const std::vector<Cell> cells = cells_of(rig.recordings[r]);
      add_to_score(before, weighed_residuals(rig, r, runs[i], cells, weighting), weighting.robust);
      add_to_score(after, weighed_residuals(rig, r, corrected(rig, r, runs[i], model), cells, weighting),
                   weighting.robust);
    }
  }
  return compare_scores(before, after);
}

}  // namespace surefoot
