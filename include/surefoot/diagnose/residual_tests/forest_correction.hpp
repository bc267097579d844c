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

#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot::diagnosis {

/// Residuals of the table's samples, in units of sigma, cut off at `limit`; 0 where nothing was measured.
Eigen::MatrixXd residual_table(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                               const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                               const FeatureTable& table, double limit = 10);

inline Eigen::MatrixXf single_precision(const Eigen::MatrixXd& values) {
  return values.cwiseMax(-1e30).cwiseMin(1e30).cast<float>();
}

/// Learns from at most about 8000 rows in which something was measured. `runs` are whole simulations.
template <Executor E>
ResidualModel train_residual_model(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                   const std::vector<SimulatedRun>& runs, const E& executor, std::uint64_t seed) {
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) rows += bound.recordings[r].rows();
  const FeatureTable table = make_features(bound, recordings, runs, std::max<Eigen::Index>(1, rows / 8000));
  ResidualModel model{table.names, {}, residual_sizes(bound, recordings, runs), {}};
  for (const OutputInfo& output : bound.info.outputs) model.outputs.push_back(output.name);
  model.scale = model.scale.unaryExpr([](double size) { return std::isfinite(size) ? size : 1; });
  std::vector<Eigen::Index> measured;
  for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
    const Recording& recording = bound.recordings[recordings[table.recording[static_cast<std::size_t>(j)]]];
    if (recording.outputs.col(table.row[static_cast<std::size_t>(j)]).array().isFinite().any()) measured.push_back(j);
  }
  if (measured.empty()) return model;
  Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs = single_precision(table.values(Eigen::all, measured));
  samples.outputs = residual_table(bound, recordings, runs, model.scale, table)(Eigen::all, measured);
  ExtraTreesOptions options;
  options.trees = 40;
  options.min_leaf = std::max(5, static_cast<int>(measured.size() / 400));
  model.forest = train_extra_trees(samples, options, executor, seed);
  return model;
}

/// A simulated recording of the bound with what the model expects taken off its outputs. Throws DiagnoseError if the
/// model asks for a feature that the simulator and the recording do not have.
SimulatedRun corrected(const BoundSimulator& bound, std::size_t recording, const SimulatedRun& run,
                       const ResidualModel& model);

/// What the forest gains in simulations of recordings it has not seen: each fold is corrected by a model of the others.
/// `runs` go with `recordings`.
template <Executor E>
Comparison cross_validate_residual(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                   const std::vector<SimulatedRun>& runs,
                                   const std::vector<std::vector<std::size_t>>& folds, const Weighting& weighting,
                                   const E& executor, std::uint64_t seed) {
  BlockLosses before, after;
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
    const ResidualModel model = train_residual_model(bound, learned, learned_runs, executor, seed);
    for (const std::size_t i : held) {
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

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/forest_correction.ipp"
#endif
