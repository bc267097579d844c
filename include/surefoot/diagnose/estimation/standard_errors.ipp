// Definitions of surefoot/diagnose/estimation/standard_errors.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE StandardErrors standard_errors(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                               const FitProblem& problem, const Parallel& parallel) {
  constexpr Eigen::Index block_rows = 50, most_blocks = 8;  // of a recording: longer than residuals stay correlated
  constexpr double ridge = 1e-9;  // on the diagonal of ones: what the data do not determine stays finite
  const FitFunctions functions(bound, hypothesis, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  StandardErrors result{functions.variables(), {}, {}};
  const auto count = static_cast<Eigen::Index>(result.variables.size());
  if (count == 0) return result;
  const Eigen::VectorXd residuals = functions.residuals(z);
  const Eigen::MatrixXd jacobian = functions.jacobian(z, residuals);
  Eigen::MatrixXd hessian = jacobian.transpose() * jacobian, gradients = Eigen::MatrixXd::Zero(count, count);
  const Eigen::VectorXd scale = hessian.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  double blocks = 0;
  for (std::size_t i = 0; i + 1 < functions.begin().size(); ++i) {
    const Eigen::Index from = functions.begin()[i], length = functions.begin()[i + 1] - from;
    const Eigen::Index parts = std::clamp<Eigen::Index>(length / block_rows, 1, most_blocks);
    for (Eigen::Index part = 0; part < parts; ++part) {
      const Eigen::Index a = from + length * part / parts, b = from + length * (part + 1) / parts;
      const Eigen::VectorXd gradient =
          scale.cwiseProduct(jacobian.middleRows(a, b - a).transpose() * residuals.segment(a, b - a));
      gradients += gradient * gradient.transpose();
      ++blocks;
    }
  }
  Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += ridge;
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(count, count));
  Eigen::MatrixXd covariance = inverse * gradients * inverse * (blocks / std::max(1.0, blocks - 1));
  covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  result.deviation.resize(count);
  result.correlation = scale.asDiagonal() * inverse * scale.asDiagonal();
  Eigen::VectorXd norm = result.correlation.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  result.correlation = norm.asDiagonal() * result.correlation * norm.asDiagonal();
  Hypothesis copy = hypothesis;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Variable& variable = result.variables[static_cast<std::size_t>(i)];
    const double unit = variable.logarithmic ? value_of(copy, variable) : variable.scale;
    result.deviation[i] = std::sqrt(std::max(0.0, covariance(i, i))) * unit;
  }
  return result;
}

}  // namespace surefoot::diagnosis
