// Definitions of surefoot/optimize/least_squares.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/least_squares.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/robust_loss.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot::detail {

/// The inverse of a^T a by its eigenvectors, and how many of them it is determined by. `open` becomes true for
/// parameters that take part in a combination that `a` does not determine.
SUREFOOT_ONCE Eigen::MatrixXd invert_normal_matrix(const Eigen::MatrixXd& a, Eigen::Index& rank,
                                                   std::vector<bool>& open) {
  constexpr double least_eigenvalue = 1e-12;  // per parameter; columns of `a` have length 1
  constexpr double takes_part = 1e-4;         // component of an eigenvector
  const SymmetricEigen eigen = eigen_of_symmetric(transposed_product(a, a));
  const Eigen::Index count = a.cols();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  open.assign(static_cast<std::size_t>(count), false);
  rank = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double* const axis = &eigen.vectors(0, k);
    if (eigen.values[k] > least_eigenvalue * static_cast<double>(count)) {
      ++rank;
      for (Eigen::Index j = 0; j < count; ++j) {
        for (Eigen::Index i = 0; i < count; ++i) inverse(i, j) += axis[i] * axis[j] / eigen.values[k];
      }
    } else {
      for (Eigen::Index i = 0; i < count; ++i) {
        if (std::abs(axis[i]) > takes_part) open[static_cast<std::size_t>(i)] = true;
      }
    }
  }
  return inverse;
}

/// The asymptotic covariance of an M-estimate (Huber 1981, section 7.6); for the squared loss the usual one, the
/// variance of a residual times the inverse of J^T J.
SUREFOOT_ONCE void estimate_covariance(LeastSquaresResult& result, const Eigen::MatrixXd& full_jacobian,
                                       const LeastSquaresOptions& options) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < result.x.size(); ++i) {
    if (!result.active_bound[static_cast<std::size_t>(i)]) free.push_back(i);
  }
  double squares = 0, mean_slope = 0;
  for (const double r : result.residuals) {
    const LossTerms terms = loss_terms(options.loss, r / options.loss_scale);
    squares += terms.weight * r * terms.weight * r;
    mean_slope += terms.slope;
  }
  const double spare = static_cast<double>(result.residuals.size()) - static_cast<double>(free.size());
  mean_slope /= static_cast<double>(result.residuals.size());
  result.deviation = spare > 0 && mean_slope > 0 ? std::sqrt(squares / spare) / mean_slope : infinity;

  result.covariance = Eigen::MatrixXd::Zero(result.x.size(), result.x.size());
  if (free.empty()) return;

  const auto count = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd normed(full_jacobian.rows(), count);  // columns of length 1
  Eigen::VectorXd scale(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::Index column = free[static_cast<std::size_t>(j)];
    const double length = column_norm(full_jacobian, column);
    scale[j] = length > 0 ? 1 / length : 1.0;
    for (Eigen::Index i = 0; i < normed.rows(); ++i) normed(i, j) = full_jacobian(i, column) * scale[j];
  }
  std::vector<bool> open;
  const Eigen::MatrixXd inverse = scaled(scale, invert_normal_matrix(normed, result.rank, open));
  for (std::size_t i = 0; i < free.size(); ++i) {
    for (std::size_t j = 0; j < free.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      double value = inverse(a, b) * result.deviation * result.deviation;
      if (open[i] || open[j]) value = a == b ? infinity : std::numeric_limits<double>::quiet_NaN();
      result.covariance(free[i], free[j]) = value;
    }
  }
}

SUREFOOT_INLINE LeastSquaresResult least_squares(const VectorFunction& residuals, const Eigen::VectorXd& start,
                                                 const LeastSquaresOptions& options, const MatrixFunction& jacobian) {
  LeastSquaresEnd end = minimise_squares(residuals, start, options, jacobian);
  if (options.covariance) estimate_covariance(end.result, end.jacobian, options);
  return std::move(end.result);
}

}  // namespace surefoot::detail
