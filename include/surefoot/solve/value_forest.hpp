// The value of a state as the solver learns it: a quadratic function of the features where that explains much of it (it
// is all there is to a linear-quadratic problem, which piecewise linear trees need many samples for), and a forest of
// what is left. Cost of one value: that of the forest, and features^2 / 2 products.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"

namespace surefoot {

/// y = sum over i <= j of coefficient z_i z_j, z = (1, x in units of its spread); kept within the outputs it was fitted
/// to, as it would run away beyond them. Empty: 0 everywhere.
template <int Inputs>
class QuadraticTrend {
 public:
  static constexpr int terms = (Inputs + 1) * (Inputs + 2) / 2;
  static constexpr Eigen::Index most_samples = 20'000;  // enough for any number of inputs here; more are thinned out
  static constexpr double ridge = 1e-6;  // of the samples' own sum of squares: keeps dependent inputs solvable
  bool empty() const { return coefficients_.empty(); }
  std::span<const double> parameters() const { return coefficients_; }  // coefficients, means, 1 / spreads, bounds
  void set_parameters(std::vector<double> parameters) { coefficients_ = std::move(parameters); }
  static constexpr std::size_t count_of_parameters = static_cast<std::size_t>(terms + 2 * Inputs + 2);

  double operator()(const float* x) const {
    const double* c = coefficients_.data();
    const double* mean = c + terms;
    const double* scale = mean + Inputs;
    double z[Inputs + 1];
    z[0] = 1;
    for (int i = 0; i < Inputs; ++i) z[i + 1] = (static_cast<double>(x[i]) - mean[i]) * scale[i];
    double y = 0;
    for (int i = 0; i <= Inputs; ++i) {
      double row = 0;
      for (int j = i; j <= Inputs; ++j) row += *c++ * z[j];
      y += row * z[i];
    }
    return std::min(std::max(y, scale[Inputs]), scale[Inputs + 1]);
  }

  /// Least squares; empty if there are too few samples.
  static QuadraticTrend fit(const Dataset<Inputs, 1>& data) {
    QuadraticTrend trend;
    const Eigen::Index stride = data.inputs.cols() / most_samples + 1;
    if (data.inputs.cols() / stride < 4 * terms) return trend;
    trend.prepare(data, stride);
    trend.solve(data, stride);
    return trend;
  }

  bool operator==(const QuadraticTrend&) const = default;

 private:
  // Means and spreads of the inputs, bounds of the outputs.
  void prepare(const Dataset<Inputs, 1>& data, Eigen::Index stride) {
    coefficients_.assign(count_of_parameters, 0.0);
    double* mean = coefficients_.data() + terms;
    double* scale = mean + Inputs;
    Vec<Inputs> sum = Vec<Inputs>::Zero(), squares = Vec<Inputs>::Zero();
    double count = 0;
    for (Eigen::Index k = 0; k < data.inputs.cols(); k += stride, count += 1)
      sum += data.inputs.col(k).template cast<double>();
    sum /= count;
    for (Eigen::Index k = 0; k < data.inputs.cols(); k += stride) {
      squares += (data.inputs.col(k).template cast<double>() - sum).cwiseAbs2();
    }
    for (int i = 0; i < Inputs; ++i) {
      mean[i] = sum[i];
      scale[i] = squares[i] > 0 ? std::sqrt(count / squares[i]) : 0.0;
    }
    scale[Inputs] = data.outputs.minCoeff();
    scale[Inputs + 1] = data.outputs.maxCoeff();
  }

  void solve(const Dataset<Inputs, 1>& data, Eigen::Index stride) {
    constexpr Eigen::Index chunk = 64;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
    Eigen::MatrixXd rows(terms, chunk);
    Eigen::VectorXd outputs(chunk);
    const double* mean = coefficients_.data() + terms;
    const double* scale = mean + Inputs;
    Eigen::Index filled = 0;
    const auto flush = [&] {
      normal.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(filled));
      right += rows.leftCols(filled) * outputs.head(filled);
      filled = 0;
    };
    for (Eigen::Index k = 0; k * stride < data.inputs.cols(); ++k) {
      double z[Inputs + 1];
      z[0] = 1;
      for (int i = 0; i < Inputs; ++i) {
        z[i + 1] = (static_cast<double>(data.inputs(i, k * stride)) - mean[i]) * scale[i];
      }
      Eigen::Index term = 0;
      for (int i = 0; i <= Inputs; ++i) {
        for (int j = i; j <= Inputs; ++j) rows(term++, filled) = z[i] * z[j];
      }
      outputs[filled++] = data.outputs(0, k * stride);
      if (filled == chunk) flush();
    }
    if (filled > 0) flush();
    normal.diagonal().array() += ridge * normal.diagonal().mean();
    const Eigen::VectorXd solution = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    std::copy(solution.begin(), solution.end(), coefficients_.begin());
  }

  std::vector<double> coefficients_;
};

/// The trend and, on top of it, the forest.
template <int Inputs>
struct ValueForest {
  QuadraticTrend<Inputs> trend;
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
void remove_trend(Dataset<Inputs, 1>& data, const QuadraticTrend<Inputs>& trend) {
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
  const auto error = [&](const QuadraticTrend<Inputs>& trend) {
    ValueForest<Inputs> value{trend, {}};
    Dataset<Inputs, 1> rest = learnt;
    if (!trend.empty()) remove_trend(rest, trend);
    value.forest = train_extra_trees<LinearLeaf>(rest, options, executor, seed, {});
    std::vector<double> predicted(static_cast<std::size_t>(held_out));
    value.predict(kept.inputs.data(), predicted.size(), predicted.data());
    return (Eigen::Map<const Eigen::RowVectorXd>(predicted.data(), held_out) - kept.outputs).squaredNorm();
  };
  const auto trend = QuadraticTrend<Inputs>::fit(learnt);
  return !trend.empty() && error(trend) < much_better * error({});
}

}  // namespace detail

/// Learns it; takes the outputs of `data` apart.
template <int Inputs, Executor E>
ValueForest<Inputs> train_value_forest(Dataset<Inputs, 1> data, const ExtraTreesOptions& options, const E& executor,
                                       std::uint64_t seed, std::stop_token stop = {}) {
  ValueForest<Inputs> value;
  if (detail::has_trend(data, options, executor, seed)) value.trend = QuadraticTrend<Inputs>::fit(data);
  if (!value.trend.empty()) detail::remove_trend(data, value.trend);
  value.forest = train_extra_trees<LinearLeaf>(data, options, executor, seed, std::move(stop));
  return value;
}

}  // namespace surefoot
