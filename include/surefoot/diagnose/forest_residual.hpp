// A forest in place of physics: learns the residuals of a model from features of the motion. What it takes from the
// error of recordings it has not seen is what no named effect needs to be believed for, and the yardstick for those.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/features.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot {

using ResidualForest = Forest<Eigen::Dynamic, Eigen::Dynamic, ConstantLeaf>;

/// Residuals of the table's samples, in units of sigma; 0 where nothing was measured.
inline Eigen::MatrixXd residual_table(const Rig& rig, const std::vector<std::size_t>& recordings,
                                      const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                                      const FeatureTable& table) {
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(sigma.size(), table.values.cols());
  for (Eigen::Index j = 0; j < residuals.cols(); ++j) {
    const std::size_t i = table.recording[static_cast<std::size_t>(j)];
    const Eigen::Index row = table.row[static_cast<std::size_t>(j)];
    for (Eigen::Index k = 0; k < sigma.size(); ++k) {
      double off = trajectories[i].outputs(k, row) - rig.recordings[recordings[i]].outputs(k, row);
      if (rig.wrapped[static_cast<std::size_t>(k)]) off = wrap_angle(off);
      if (std::isfinite(off)) residuals(k, j) = std::clamp(off / sigma[k], -10.0, 10.0);
    }
  }
  return residuals;
}

template <Executor E>
ResidualForest train_residual_forest(const FeatureTable& table, const Eigen::MatrixXd& residuals, const E& executor,
                                     std::uint64_t seed) {
  Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs = table.values.cast<float>();
  samples.outputs = residuals;
  ExtraTreesOptions options;
  options.trees = 40;
  options.min_leaf = std::max(5, static_cast<int>(table.values.cols() / 400));
  return train_extra_trees(samples, options, executor, seed);
}

/// Root mean square that is left of the residuals after the forest's prediction.
inline double left_after(const ResidualForest& forest, const FeatureTable& table, const Eigen::MatrixXd& residuals) {
  if (table.values.cols() == 0) return 0;
  double sum = 0;
  for (Eigen::Index j = 0; j < residuals.cols(); ++j) {
    const Eigen::VectorXd predicted = forest.predict(Eigen::VectorXd(table.values.col(j)));
    sum += (residuals.col(j) - predicted).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(residuals.size()));
}

}  // namespace surefoot
