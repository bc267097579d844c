// The value of a state as the solver learns it: a quadratic function of the features where that explains much of it,
// and a forest of what is left. Cost of one value: that of the forest, and features^2 / 2 products.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/solve/quadratic_trend.hpp"

namespace surefoot {

/// The trend and, on top of it, the forest.
template <int Inputs>
struct ValueForest {
  QuadraticTrend trend;
  Forest<Inputs, 1, LinearLeaf> forest;

  bool empty() const { return forest.empty(); }
  std::size_t trees() const { return forest.trees(); }

  void predict(const float* inputs, std::size_t count, double* out) const {
    forest.predict(inputs, count, out);
    if (trend.empty()) return;
    for (std::size_t i = 0; i < count; ++i) out[i] += trend(inputs + i * Inputs);
  }

  /// What each tree says by itself.
  void predict_trees(const float* input, double* out) const {
    forest.predict_trees(input, 1, out);
    const double base = trend.empty() ? 0.0 : trend(input);
    for (std::size_t t = 0; t < trees(); ++t) out[t] += base;
  }

  bool operator==(const ValueForest&) const = default;
};

namespace detail {

constexpr std::size_t trend_samples = 3000;  // that tell whether there is a trend
constexpr int trend_trees = 4;               // of each of the two forests that are compared: enough to tell them apart

/// Takes the trend from the outputs.
template <int Inputs>
void remove_trend(Dataset<Inputs, 1>& data, const QuadraticTrend& trend) {
  for (Eigen::Index k = 0; k < data.inputs.cols(); ++k) data.outputs(0, k) -= trend(data.inputs.col(k).data());
}

/// Whether the trend predicts samples that nothing was fitted to much better than a forest alone does. Where the values
/// have edges it can only add waves that the forest must learn to undo.
template <int Inputs, Executor E>
bool has_trend(const Dataset<Inputs, 1>& data, ExtraTreesOptions options, const E& executor, std::uint64_t seed) {
  constexpr Eigen::Index every = 5;    // one of so many is predicted
  constexpr double much_better = 0.5;  // of the mean squared error of the forest alone
  const auto count = std::min(static_cast<Eigen::Index>(trend_samples), data.inputs.cols());
  const Eigen::Index held_out = count / every;
  if (held_out == 0) return false;
  Dataset<Inputs, 1> learnt, kept;
  learnt.inputs.resize(Inputs, count - held_out);
  learnt.outputs.resize(1, count - held_out);
  kept.inputs.resize(Inputs, held_out);
  kept.outputs.resize(1, held_out);
  Eigen::Index a = 0, b = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index from = i * data.inputs.cols() / count;
    const bool keep = i % every == 0 && b < held_out;
    auto& to = keep ? kept : learnt;
    const Eigen::Index column = keep ? b++ : a++;
    to.inputs.col(column) = data.inputs.col(from);
    to.outputs.col(column) = data.outputs.col(from);
  }
  options.trees = std::min(options.trees, trend_trees);
  const auto error = [&](const QuadraticTrend& trend) {
    ValueForest<Inputs> value{trend, {}};
    Dataset<Inputs, 1> rest = learnt;
    if (!trend.empty()) remove_trend(rest, trend);
    value.forest = train_extra_trees<LinearLeaf>(rest, options, executor, seed, {});
    std::vector<double> predicted(static_cast<std::size_t>(held_out));
    value.predict(kept.inputs.data(), predicted.size(), predicted.data());
    return (Eigen::Map<const Eigen::RowVectorXd>(predicted.data(), held_out) - kept.outputs).squaredNorm();
  };
  const auto trend = QuadraticTrend::fit(view_of(learnt));
  return !trend.empty() && error(trend) < much_better * error({});
}

}  // namespace detail

/// Learns it; takes the outputs of `data` apart.
template <int Inputs, Executor E>
ValueForest<Inputs> train_value_forest(Dataset<Inputs, 1> data, const ExtraTreesOptions& options, const E& executor,
                                       std::uint64_t seed, std::stop_token stop = {}) {
  ValueForest<Inputs> value;
  if (detail::has_trend(data, options, executor, seed)) value.trend = QuadraticTrend::fit(detail::view_of(data));
  if (!value.trend.empty()) detail::remove_trend(data, value.trend);
  value.forest = train_extra_trees<LinearLeaf>(data, options, executor, seed, std::move(stop));
  return value;
}

}  // namespace surefoot
