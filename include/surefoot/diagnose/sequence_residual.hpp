// What final poses alone can show of unknown physics: whether the errors of sequences can be predicted, on sequences
// not used, from what was ordered and where the path went. Ridge regression on a few sums over each sequence.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/calibrate.hpp"
#include "surefoot/diagnose/score.hpp"

namespace surefoot {

namespace detail {

/// Means over a sequence of orders, their sizes and products, and of the path: place and heading, once and twice
/// around.
inline Eigen::VectorXd sequence_features(const Rig& rig, std::size_t r, const SimulatedRun& run) {
  const PlanarInfo& planar = *rig.info.planar;
  const Recording& recording = rig.recordings[r];
  const Eigen::Index m = recording.inputs.rows(), rows = std::max<Eigen::Index>(1, recording.rows() - 1);
  std::vector<double> sums(static_cast<std::size_t>(2 * m + m * (m - 1) / 2 + 6), 0.0);
  for (Eigen::Index row = 0; row < rows; ++row) {
    std::size_t k = 0;
    for (Eigen::Index i = 0; i < m; ++i) {
      const double u = recording.inputs(i, row);
      sums[k++] += u;
      sums[k++] += std::abs(u);
      for (Eigen::Index j = 0; j < i; ++j) sums[k++] += std::abs(u * recording.inputs(j, row));
    }
    const double heading = run.states(planar.heading, row);
    for (const double value : {run.states(planar.x, row), run.states(planar.y, row), std::cos(heading),
                               std::sin(heading), std::cos(2 * heading), std::sin(2 * heading)}) {
      sums[k++] += value;
    }
  }
  return Eigen::Map<Eigen::VectorXd>(sums.data(), static_cast<Eigen::Index>(sums.size())) / static_cast<double>(rows);
}

}  // namespace detail

/// The gain on held-out folds of such a prediction over none; a large one means that something is missing.
inline Comparison sequence_structure(const Rig& rig, const Hypothesis& hypothesis, const FitProblem& problem,
                                     const std::vector<std::vector<std::size_t>>& folds, const Parallel& parallel) {
  std::vector<std::size_t> order;
  std::vector<std::size_t> fold_of;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    for (const std::size_t r : folds[f]) {
      order.push_back(r);
      fold_of.push_back(f);
    }
  }
  const auto runs = simulate_all(rig, hypothesis, order, problem.integration, parallel);
  std::vector<Eigen::VectorXd> residuals, features;
  for (std::size_t i = 0; i < order.size(); ++i) {
    residuals.push_back(raw_residuals(rig, order[i], runs[i], cells_of(rig.recordings[order[i]])));
    features.push_back(detail::sequence_features(rig, order[i], runs[i]));
    if (residuals[i].size() != residuals[0].size() || !residuals[i].allFinite()) return {};
  }
  const auto count = static_cast<Eigen::Index>(order.size()), d = features[0].size(), k = residuals[0].size();
  if (count < 20 || k == 0) return {};
  Eigen::MatrixXd x(count, d), y(count, k);
  for (Eigen::Index i = 0; i < count; ++i) {
    x.row(i) = features[static_cast<std::size_t>(i)];
    y.row(i) = residuals[static_cast<std::size_t>(i)];
  }
  y = (y.array().rowwise() /
       (y.colwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt().cwiseMax(1e-12).array())
          .eval();
  x.rowwise() -= x.colwise().mean().eval();
  const Eigen::RowVectorXd size = (x.colwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt().cwiseMax(1e-12);
  x = x.array().rowwise() / size.array();
  x.conservativeResize(Eigen::NoChange, d + 1);
  x.col(d).setOnes();  // what all sequences share
  std::vector<Score> before(static_cast<std::size_t>(k)), after = before;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    Eigen::MatrixXd gram = 0.2 * static_cast<double>(count) * Eigen::MatrixXd::Identity(d + 1, d + 1);  // ridge
    Eigen::MatrixXd moment = Eigen::MatrixXd::Zero(d + 1, k);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (fold_of[static_cast<std::size_t>(i)] == f) continue;
      gram += x.row(i).transpose() * x.row(i);
      moment += x.row(i).transpose() * y.row(i);
    }
    const Eigen::MatrixXd weights = gram.ldlt().solve(moment);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (fold_of[static_cast<std::size_t>(i)] != f) continue;
      for (Eigen::Index j = 0; j < k; ++j) {
        const Eigen::VectorXd off = y.block(i, j, 1, 1), left = off - x.row(i) * weights.col(j);
        add_to_score(before[static_cast<std::size_t>(j)], off, problem.weighting.robust);
        add_to_score(after[static_cast<std::size_t>(j)], left, problem.weighting.robust);
      }
    }
  }
  Comparison best;  // one output is enough; its p-value pays for the choice
  for (std::size_t j = 0; j < before.size(); ++j) {
    Comparison one = compare_scores(before[j], after[j]);
    one.p_value = std::min(1.0, one.p_value * static_cast<double>(k));
    if (one.p_value < best.p_value) best = one;
  }
  return best;
}

}  // namespace surefoot
