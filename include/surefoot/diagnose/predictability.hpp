// Whether residuals can be predicted, on recordings not used, from what the machine did at the time: a forest is
// trained on all folds but one. Sees what depends on place, heading or orders even where residuals have no memory.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/forest_residual.hpp"
#include "surefoot/diagnose/score.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot {

namespace detail {

/// The same from one set of features.
inline Comparison predictability_from(const Rig& rig, const Hypothesis& hypothesis, const FitProblem& problem,
                                      const std::vector<std::vector<std::size_t>>& folds, bool states_only,
                                      const Parallel& parallel, std::uint64_t seed) {
  constexpr double samples = 6000;
  const Eigen::VectorXd& sigma = problem.weighting.sigma;
  const double limit = problem.weighting.robust;
  std::vector<FeatureTable> tables(folds.size());
  std::vector<Eigen::MatrixXd> residuals(folds.size());
  double rows = 1;
  for (const auto& fold : folds) {
    for (const std::size_t r : fold) rows += static_cast<double>(rig.recordings[r].rows());
  }
  const auto stride = static_cast<Eigen::Index>(std::ceil(rows / samples));
  for (std::size_t f = 0; f < folds.size(); ++f) {
    const auto runs = simulate_all(rig, hypothesis, folds[f], problem.integration, parallel);
    tables[f] = make_features(rig, folds[f], runs, stride);
    if (states_only) tables[f] = only_states(rig, tables[f]);
    residuals[f] = residual_table(rig, folds[f], runs, sigma, tables[f], limit);
  }
  std::vector<Eigen::MatrixXd> left = residuals;
  parallel(folds.size(), [&](std::size_t f) {
    Eigen::Index count = 0, at = 0;
    for (std::size_t g = 0; g < folds.size(); ++g) count += g == f ? 0 : tables[g].values.cols();
    if (count < 50) return;
    Dataset<Eigen::Dynamic, Eigen::Dynamic> known;
    known.inputs.resize(tables[f].values.rows(), count);
    known.outputs.resize(sigma.size(), count);
    for (std::size_t g = 0; g < folds.size(); ++g) {
      if (g == f) continue;
      known.inputs.middleCols(at, tables[g].values.cols()) = tables[g].values.cast<float>();
      known.outputs.middleCols(at, tables[g].values.cols()) = residuals[g];
      at += tables[g].values.cols();
    }
    ExtraTreesOptions options;
    options.trees = 40;
    options.min_leaf = std::max(5, static_cast<int>(count / 200));
    const auto forest = train_extra_trees(known, options, Serial{}, seed + f);
    for (Eigen::Index j = 0; j < left[f].cols(); ++j) {
      left[f].col(j) -= forest.predict(Eigen::VectorXd(tables[f].values.col(j)));
    }
  });
  std::vector<Score> before(static_cast<std::size_t>(sigma.size())), after = before;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    for (Eigen::Index k = 0; k < sigma.size(); ++k) {
      add_to_score(before[static_cast<std::size_t>(k)], residuals[f].row(k), limit);
      add_to_score(after[static_cast<std::size_t>(k)], left[f].row(k), limit);
    }
  }
  Comparison best;
  for (std::size_t k = 0; k < before.size(); ++k) {
    Comparison one = compare_scores(before[k], after[k]);
    one.p_value = std::min(1.0, one.p_value * static_cast<double>(before.size()));
    if (one.p_value < best.p_value) best = one;
  }
  return best;
}

}  // namespace detail

/// The gain of such a prediction over none, for the output that shows it best: from all features, and from the states
/// alone, which finds small places better. The p-value pays for both choices.
inline Comparison residual_predictability(const Rig& rig, const Hypothesis& hypothesis, const FitProblem& problem,
                                          const std::vector<std::vector<std::size_t>>& folds, const Parallel& parallel,
                                          std::uint64_t seed) {
  Comparison best;
  for (const bool states_only : {false, true}) {
    Comparison one = detail::predictability_from(rig, hypothesis, problem, folds, states_only, parallel, seed);
    one.p_value = std::min(1.0, 2 * one.p_value);
    if (one.p_value < best.p_value) best = one;
  }
  return best;
}

}  // namespace surefoot
