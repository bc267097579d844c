// Definitions of surefoot/diagnose/residual_tests/predictability.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/diagnose/residual_tests/predictability.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<Eigen::MatrixXd> left_unpredicted(const std::vector<FeatureTable>& tables,
                                                            const std::vector<Eigen::MatrixXd>& residuals,
                                                            const Parallel& parallel, std::uint64_t seed) {
  std::vector<Eigen::MatrixXd> left = residuals;
  parallel(tables.size(), [&](std::size_t f) {
    Eigen::Index count = 0, at = 0;
    for (std::size_t g = 0; g < tables.size(); ++g) count += g == f ? 0 : tables[g].values.cols();
    if (count < 50) return;
    Dataset<Eigen::Dynamic, Eigen::Dynamic> known;
    known.inputs.resize(tables[f].values.rows(), count);
    known.outputs.resize(residuals[f].rows(), count);
    for (std::size_t g = 0; g < tables.size(); ++g) {
      if (g == f) continue;
      for (Eigen::Index j = 0; j < tables[g].values.cols(); ++j, ++at) {
        for (Eigen::Index k = 0; k < known.inputs.rows(); ++k) {
          known.inputs(k, at) = static_cast<float>(tables[g].values(k, j));
        }
        for (Eigen::Index k = 0; k < known.outputs.rows(); ++k) known.outputs(k, at) = residuals[g](k, j);
      }
    }
    const int min_leaf = std::max(5, static_cast<int>(count / 200));
    const ResidualForest forest = train_forest(known, min_leaf, serially(), seed + f);
    for (Eigen::Index j = 0; j < left[f].cols(); ++j) {
      const Eigen::VectorXd expected = forest.predict(surefoot::detail::column_of(tables[f].values, j));
      for (Eigen::Index k = 0; k < expected.size(); ++k) left[f](k, j) -= expected[k];
    }
  });
  return left;
}

SUREFOOT_ONCE Comparison most_predicted(const std::vector<Eigen::MatrixXd>& residuals,
                                        const std::vector<Eigen::MatrixXd>& left, double limit) {
  const Eigen::Index outputs = residuals.empty() ? 0 : residuals.front().rows();
  std::vector<BlockLosses> before(static_cast<std::size_t>(outputs)), after = before;
  for (std::size_t f = 0; f < residuals.size(); ++f) {
    for (Eigen::Index k = 0; k < outputs; ++k) {
      append_losses(before[static_cast<std::size_t>(k)], surefoot::detail::row_of(residuals[f], k), limit);
      append_losses(after[static_cast<std::size_t>(k)], surefoot::detail::row_of(left[f], k), limit);
    }
  }
  Comparison best;
  for (std::size_t k = 0; k < before.size(); ++k) {
    Comparison one = compare_losses(before[k], after[k]);
    one.p_value = std::min(1.0, one.p_value * static_cast<double>(before.size()));
    if (one.p_value < best.p_value) best = one;
  }
  return best;
}

SUREFOOT_ONCE Comparison residual_predictability(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                 const FitProblem& problem,
                                                 const std::vector<std::vector<std::size_t>>& folds,
                                                 const Parallel& parallel, std::uint64_t seed) {
  constexpr double samples = 6000;
  const double limit = problem.weighting.robust;
  double rows = 1;
  for (const auto& fold : folds) {
    for (const std::size_t r : fold) rows += static_cast<double>(bound.recordings[r].rows());
  }
  const auto stride = static_cast<Eigen::Index>(std::ceil(rows / samples));
  std::vector<FeatureTable> tables;
  std::vector<Eigen::MatrixXd> residuals;
  for (const auto& fold : folds) {
    const auto runs = simulate_all(bound, hypothesis, fold, problem.integration, parallel);
    tables.push_back(make_features(bound, fold, runs, stride, InputsOf::row_before));
    residuals.push_back(residual_table(bound, fold, runs, problem.weighting.sigma, tables.back(), limit));
  }
  Comparison best;
  for (const bool states_only : {false, true}) {
    if (states_only) {
      for (FeatureTable& table : tables) table = only_states(bound, table);
    }
    const auto left = left_unpredicted(tables, residuals, parallel, seed);
    Comparison one = most_predicted(residuals, left, limit);
    one.p_value = std::min(1.0, 2 * one.p_value);
    if (one.p_value < best.p_value) best = one;
  }
  return best;
}

}  // namespace surefoot::diagnosis
