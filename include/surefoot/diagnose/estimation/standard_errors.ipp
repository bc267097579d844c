// Definitions of surefoot/diagnose/estimation/standard_errors.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Sum over blocks of the recordings of the outer products of their gradients.
SUREFOOT_ONCE Eigen::MatrixXd products_of_gradients(const FitFunctions& functions, const Eigen::VectorXd& residuals,
                                                    const Eigen::MatrixXd& jacobian) {
  constexpr Eigen::Index block_rows = 50, most_blocks = 8;  // of a recording: longer than residuals stay correlated
  const Eigen::Index count = jacobian.cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(count, count);
  double blocks = 0;
  for (std::size_t r = 0; r + 1 < functions.begin().size(); ++r) {
    const Eigen::Index from = functions.begin()[r], length = functions.begin()[r + 1] - from;
    const Eigen::Index parts = std::clamp<Eigen::Index>(length / block_rows, 1, most_blocks);
    for (Eigen::Index part = 0; part < parts; ++part) {
      const Eigen::Index a = from + length * part / parts, b = from + length * (part + 1) / parts;
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
      for (Eigen::Index k = 0; k < count; ++k) {
        for (Eigen::Index i = a; i < b; ++i) gradient[k] += jacobian(i, k) * residuals[i];
      }
      for (Eigen::Index j = 0; j < count; ++j) {
        for (Eigen::Index i = 0; i < count; ++i) sum(i, j) += gradient[i] * gradient[j];
      }
      ++blocks;
    }
  }
  sum *= blocks / std::max(1.0, blocks - 1);
  return sum;
}

SUREFOOT_ONCE StandardErrors standard_errors(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const FitProblem& problem, const Parallel& parallel) {
  using surefoot::detail::product, surefoot::detail::scaled, surefoot::detail::transposed_product;
  const FitFunctions functions(bound, hypothesis, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  StandardErrors result{functions.variables(), {}, {}};
  const auto count = static_cast<Eigen::Index>(result.variables.size());
  if (count == 0) return result;
  const Eigen::VectorXd residuals = functions.residuals(z);
  const Eigen::MatrixXd jacobian = functions.central_jacobian(z, residuals);
  Hypothesis copy = hypothesis;
  Eigen::VectorXd width(count);  // of the prior: units in which what is not known at all has the variance 1
  for (Eigen::Index i = 0; i < count; ++i) {
    const Variable& variable = result.variables[static_cast<std::size_t>(i)];
    width[i] = prior_width(variable, value_of(copy, variable));
  }
  Eigen::MatrixXd hessian = scaled(width, transposed_product(jacobian, jacobian));
  Eigen::MatrixXd gradients = scaled(width, products_of_gradients(functions, residuals, jacobian));
  double curvature = 0, slopes = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    curvature += hessian(i, i);
    slopes += gradients(i, i);
  }
  const double variance = curvature > 0 && slopes > 0 ? slopes / curvature : 1;  // of a residual, with its memory

  // Posterior covariance, the prior being one more recording of which the variance is known.
  for (Eigen::Index i = 0; i < count; ++i) {
    hessian(i, i) += variance;
    gradients(i, i) += variance * variance;
  }
  const Eigen::MatrixXd inverse = surefoot::detail::invert_symmetric(hessian);
  const Eigen::MatrixXd covariance = product(product(inverse, gradients), inverse);
  Eigen::VectorXd norm(count);
  for (Eigen::Index i = 0; i < count; ++i) norm[i] = 1 / std::sqrt(std::max(inverse(i, i), 1e-300));
  result.correlation = scaled(norm, inverse);
  result.deviation.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Variable& variable = result.variables[static_cast<std::size_t>(i)];
    const double unit = variable.logarithmic ? value_of(copy, variable) : variable.scale;
    result.deviation[i] = std::sqrt(std::max(0.0, covariance(i, i))) * width[i] * unit;
  }
  return result;
}

}  // namespace surefoot::diagnosis
