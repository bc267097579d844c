// A quadratic function fitted to the values of states: all there is to a linear-quadratic problem, which piecewise
// linear trees need many samples for. Cost of one value: inputs^2 / 2 products; of a fit: samples * inputs^4 / 8.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot {

/// y = sum over i <= j of coefficient z_i z_j, z = (1, x in units of its spread); kept within the outputs it was fitted
/// to, as it would run away beyond them. Empty: 0 everywhere.
class QuadraticTrend {
 public:
  static constexpr Eigen::Index most_samples = 20'000;  // enough for any number of inputs here; more are thinned out
  static constexpr Eigen::Index most_inputs = 64;       // a fit of more costs more than the forest that it would help
  static constexpr double ridge = 1e-6;  // of the samples' own sum of squares: keeps dependent inputs solvable

  QuadraticTrend() = default;

  /// From parameters(): none, or count_of_parameters(inputs).
  QuadraticTrend(std::vector<double> parameters, Eigen::Index inputs);

  static std::size_t count_of_parameters(Eigen::Index inputs);

  bool empty() const { return parameters_.empty(); }
  std::span<const double> parameters() const { return parameters_; }  // coefficients, means, 1 / spreads, bounds

  /// Its value where the inputs are x[0], x[1], ...; not for an empty one.
  double operator()(const float* x) const;

  /// Least squares over samples of one output; empty if there are too few for so many inputs, or too many inputs.
  static QuadraticTrend fit(const detail::DatasetView& samples);

  bool operator==(const QuadraticTrend&) const = default;

 private:
  void scale(const detail::DatasetView& samples, Eigen::Index stride);
  void solve(const detail::DatasetView& samples, Eigen::Index stride);

  Eigen::Index inputs_ = 0;
  std::vector<double> parameters_;
};

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/solve/quadratic_trend.ipp"
#endif
