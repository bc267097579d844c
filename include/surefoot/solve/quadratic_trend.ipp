// Definitions of surefoot/solve/quadratic_trend.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/positive_definite.hpp"
#include "surefoot/solve/quadratic_trend.hpp"

namespace surefoot {

namespace detail {

/// Products z_i z_j, i <= j.
SUREFOOT_INLINE Eigen::Index quadratic_terms(Eigen::Index inputs) { return (inputs + 1) * (inputs + 2) / 2; }

/// The terms of four samples at a time, times the transpose of themselves and times their outputs, summed.
struct NormalEquations {
  static constexpr std::size_t lanes = 4;  // samples whose products are added in one pass over the matrix

  explicit NormalEquations(std::size_t count)
      : terms(count), matrix(count * count, 0.0), right(count, 0.0), rows(lanes * count, 0.0) {}

  /// Room for the terms of the next sample.
  double* next(double output) {
    outputs[filled] = output;
    return rows.data() + filled++ * terms;
  }

  bool full() const { return filled == lanes; }

  /// Adds what was filled in.
  void add() {
    std::fill(rows.begin() + static_cast<std::ptrdiff_t>(filled * terms), rows.end(), 0.0);
    std::fill(outputs.begin() + static_cast<std::ptrdiff_t>(filled), outputs.end(), 0.0);
    const double* const a = rows.data();
    const double *const b = a + terms, *const c = b + terms, *const d = c + terms;
    for (std::size_t j = 0; j < terms; ++j) {
      double* const column = matrix.data() + j * terms;
      for (std::size_t i = j; i < terms; ++i) column[i] += (a[i] * a[j] + b[i] * b[j]) + (c[i] * c[j] + d[i] * d[j]);
      right[j] += (a[j] * outputs[0] + b[j] * outputs[1]) + (c[j] * outputs[2] + d[j] * outputs[3]);
    }
    filled = 0;
  }

  /// The solution with a share `ridge` of the mean of the diagonal added to it.
  std::vector<double> solve(double ridge) {
    double sum = 0;
    for (std::size_t j = 0; j < terms; ++j) sum += matrix[j * terms + j];
    for (std::size_t j = 0; j < terms; ++j) matrix[j * terms + j] += ridge * sum / static_cast<double>(terms);
    solve_positive_definite(matrix, terms, right, 1);
    return right;
  }

  std::size_t terms;
  std::vector<double> matrix, right, rows;  // lower half of the matrix, column after column
  std::array<double, lanes> outputs{};
  std::size_t filled = 0;
};

}  // namespace detail

SUREFOOT_INLINE QuadraticTrend::QuadraticTrend(std::vector<double> parameters, Eigen::Index inputs)
    : inputs_(inputs), parameters_(std::move(parameters)) {}

SUREFOOT_INLINE std::size_t QuadraticTrend::count_of_parameters(Eigen::Index inputs) {
  return static_cast<std::size_t>(detail::quadratic_terms(inputs) + 2 * inputs + 2);
}

SUREFOOT_INLINE double QuadraticTrend::operator()(const float* x) const {
  const double* c = parameters_.data();
  const double* mean = c + detail::quadratic_terms(inputs_);
  const double* scale = mean + inputs_;
  std::array<double, most_inputs + 1> z;
  z[0] = 1;
  for (Eigen::Index i = 0; i < inputs_; ++i) {
    z[static_cast<std::size_t>(i) + 1] = (static_cast<double>(x[i]) - mean[i]) * scale[i];
  }
  const auto last = static_cast<std::size_t>(inputs_);
  double y = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    double row = 0;
    for (std::size_t j = i; j <= last; ++j) row += *c++ * z[j];
    y += row * z[i];
  }
  return std::min(std::max(y, scale[inputs_]), scale[inputs_ + 1]);
}

SUREFOOT_INLINE QuadraticTrend QuadraticTrend::fit(const detail::DatasetView& samples) {
  const Eigen::Index stride = samples.count / most_samples + 1;
  const Eigen::Index terms = detail::quadratic_terms(samples.input_rows);
  if (samples.input_rows > most_inputs || samples.count / stride < 4 * terms) return {};
  QuadraticTrend trend;
  trend.inputs_ = samples.input_rows;
  trend.parameters_.assign(count_of_parameters(samples.input_rows), 0.0);
  trend.scale(samples, stride);
  trend.solve(samples, stride);
  return trend;
}

// Means and spreads of the inputs, bounds of the outputs.
SUREFOOT_INLINE void QuadraticTrend::scale(const detail::DatasetView& samples, Eigen::Index stride) {
  double* const mean = parameters_.data() + detail::quadratic_terms(inputs_);
  double* const scale = mean + inputs_;
  for (Eigen::Index i = 0; i < inputs_; ++i) {
    const auto value = [&](Eigen::Index k) { return static_cast<double>(samples.inputs[k * inputs_ + i]); };
    double sum = 0, squares = 0, count = 0;
    for (Eigen::Index k = 0; k < samples.count; k += stride, count += 1) sum += value(k);
    mean[i] = sum / count;
    for (Eigen::Index k = 0; k < samples.count; k += stride) squares += (value(k) - mean[i]) * (value(k) - mean[i]);
    scale[i] = squares > 0 ? std::sqrt(count / squares) : 0.0;
  }
  const auto [least, most] = std::minmax_element(samples.outputs, samples.outputs + samples.count);
  scale[inputs_] = *least;
  scale[inputs_ + 1] = *most;
}

SUREFOOT_INLINE void QuadraticTrend::solve(const detail::DatasetView& samples, Eigen::Index stride) {
  const double* const mean = parameters_.data() + detail::quadratic_terms(inputs_);
  const double* const scale = mean + inputs_;
  detail::NormalEquations equations(static_cast<std::size_t>(detail::quadratic_terms(inputs_)));
  const auto last = static_cast<std::size_t>(inputs_);
  std::array<double, most_inputs + 1> z;
  z[0] = 1;
  for (Eigen::Index k = 0; k < samples.count; k += stride) {
    const float* const x = samples.inputs + k * inputs_;
    for (std::size_t i = 0; i < last; ++i) z[i + 1] = (static_cast<double>(x[i]) - mean[i]) * scale[i];
    double* term = equations.next(samples.outputs[k]);
    for (std::size_t i = 0; i <= last; ++i) {
      for (std::size_t j = i; j <= last; ++j) *term++ = z[i] * z[j];
    }
    if (equations.full()) equations.add();
  }
  equations.add();
  const std::vector<double> solution = equations.solve(ridge);
  std::copy(solution.begin(), solution.end(), parameters_.begin());
}

}  // namespace surefoot
