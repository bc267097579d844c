// Definitions of surefoot/diagnose/estimation/standard_errors.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE StandardErrors standard_errors(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const FitProblem& problem, const Parallel& parallel) {
  constexpr Eigen::Index block_rows = 50, most_blocks = 8;  // of a recording: longer than residuals stay correlated
  using surefoot::detail::product, surefoot::detail::scaled, surefoot::detail::transposed_product;
  constexpr double ridge = 1e-9;  // on the diagonal of ones: what the data do not determine stays finite
  const FitFunctions functions(bound, hypothesis, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  StandardErrors result{functions.variables(), {}, {}};
  const auto count = static_cast<Eigen::Index>(result.variables.size());
  if (count == 0) return result;
  const Eigen::VectorXd residuals = functions.residuals(z);
  const Eigen::MatrixXd jacobian = functions.jacobian(z, residuals);
  const Eigen::MatrixXd hessian = transposed_product(jacobian, jacobian);
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd scale(count);
  for (Eigen::Index i = 0; i < count; ++i) scale[i] = hessian(i, i) > 0 ? 1 / std::sqrt(hessian(i, i)) : 0.0;
  double blocks = 0;
  for (std::size_t i = 0; i + 1 < functions.begin().size(); ++i) {
    const Eigen::Index from = functions.begin()[i], length = functions.begin()[i + 1] - from;
    const Eigen::Index parts = std::clamp<Eigen::Index>(length / block_rows, 1, most_blocks);
    for (Eigen::Index part = 0; part < parts; ++part) {
      const Eigen::Index a = from + length * part / parts, b = from + length * (part + 1) / parts;
      Eigen::MatrixXd rows(b - a, count);
      Eigen::VectorXd off(b - a);
      for (Eigen::Index i = 0; i < off.size(); ++i) off[i] = residuals[a + i];
      for (Eigen::Index k = 0; k < count; ++k) {
        for (Eigen::Index i = 0; i < off.size(); ++i) rows(i, k) = jacobian(a + i, k);
      }
      Eigen::VectorXd gradient = transposed_product(rows, off);
      for (Eigen::Index k = 0; k < count; ++k) gradient[k] *= scale[k];
      for (Eigen::Index j = 0; j < count; ++j) {
        for (Eigen::Index i = 0; i < count; ++i) gradients(i, j) += gradient[i] * gradient[j];
      }
      ++blocks;
    }
  }
  Eigen::MatrixXd information = scaled(scale, hessian);
  for (Eigen::Index i = 0; i < count; ++i) information(i, i) += ridge;
  const Eigen::MatrixXd inverse = surefoot::detail::invert_symmetric(information);
  Eigen::MatrixXd covariance = product(product(inverse, gradients), inverse);
  covariance *= blocks / std::max(1.0, blocks - 1);
  covariance = scaled(scale, covariance);
  result.deviation.resize(count);
  result.correlation = scaled(scale, inverse);
  Eigen::VectorXd norm(count);
  for (Eigen::Index i = 0; i < count; ++i) norm[i] = 1 / std::sqrt(std::max(result.correlation(i, i), 1e-300));
  result.correlation = scaled(norm, result.correlation);
  Hypothesis copy = hypothesis;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Variable& variable = result.variables[static_cast<std::size_t>(i)];
    const double unit = variable.logarithmic ? value_of(copy, variable) : variable.scale;
    result.deviation[i] = std::sqrt(std::max(0.0, covariance(i, i))) * unit;
  }
  return result;
}

}  // namespace surefoot::diagnosis
