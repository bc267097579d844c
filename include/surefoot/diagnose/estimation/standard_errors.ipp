// Definitions of surefoot/diagnose/estimation/standard_errors.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

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

/// Of a residual, with its memory: what gradients scatter by, against the curvature.
SUREFOOT_ONCE double variance_of_residuals(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& gradients) {
  double slopes = 0;
  for (Eigen::Index k = 0; k < gradients.cols(); ++k) slopes += gradients(k, k);
  const double curvature = surefoot::detail::dot(jacobian.data(), jacobian.data(), jacobian.size());
  return curvature > 0 && slopes > 0 ? slopes / curvature : 1;
}

/// Half the change of the residuals between both ends of a step to both sides; empty where one of them cannot be
/// simulated.
SUREFOOT_ONCE Eigen::VectorXd change_along(const FitFunctions& functions, const Eigen::VectorXd& z,
                                           const Eigen::VectorXd& step) {
  Eigen::VectorXd forth = z, back = z;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    forth[k] += step[k];
    back[k] -= step[k];
  }
  Eigen::VectorXd change = functions.residuals(forth);
  const Eigen::VectorXd other = functions.residuals(back);
  for (Eigen::Index i = 0; i < change.size(); ++i) change[i] = 0.5 * (change[i] - other[i]);
  return surefoot::all_finite(change) ? change : Eigen::VectorXd();
}

/// The share of a step by which both of its sides stay within the box.
SUREFOOT_ONCE double share_within(const Box<Eigen::Dynamic>& box, const Eigen::VectorXd& z,
                                  const Eigen::VectorXd& step) {
  double share = 1;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const double room = std::min(z[k] - box.low()[k], box.high()[k] - z[k]);
    if (step[k] != 0) share = std::min(share, room / std::abs(step[k]));
  }
  return share;
}

/// Derivatives in units of the prior, along the directions that the recordings determine least by differences as wide
/// as what is not known there: where friction sticks a simulation jumps a little, and small differences make knowledge
/// of that.
SUREFOOT_ONCE Eigen::MatrixXd with_wide_differences(const FitFunctions& functions, const Eigen::VectorXd& z,
                                                    const Eigen::VectorXd& width, Eigen::MatrixXd jacobian,
                                                    double variance) {
  constexpr Eigen::Index most_directions = 8;  // the least determined ones
  constexpr int most_rounds = 4;               // each many times as wide as the one before, up to the prior's width
  constexpr double much_less = 0.5;            // of the information, below which the small differences misled
  constexpr double least_share = 0.1;          // of a step: at a bound there is no room to both sides
  const Box<Eigen::Dynamic> box = functions.box();
  const auto directions =
      surefoot::detail::eigen_of_symmetric(surefoot::detail::transposed_product(jacobian, jacobian));
  for (Eigen::Index j = 0; j < std::min(most_directions, z.size()); ++j) {
    const Eigen::VectorXd direction = surefoot::detail::column_of(directions.vectors, j);
    const Eigen::VectorXd before = surefoot::detail::product(jacobian, direction);
    Eigen::VectorXd along = before;
    for (int round = 0; round < most_rounds; ++round) {
      const double information = surefoot::detail::sum_of_squares(along);
      const double deviation = std::sqrt(variance / (information + variance));
      Eigen::VectorXd step(z.size());
      for (Eigen::Index k = 0; k < z.size(); ++k) step[k] = deviation * direction[k] * width[k];
      const double share = share_within(box, z, step);
      if (share < least_share) break;
      for (double& one : step) one *= share;
      Eigen::VectorXd change = change_along(functions, z, step);
      if (change.size() == 0) break;
      for (double& one : change) one /= share * deviation;
      if (!(surefoot::detail::sum_of_squares(change) < much_less * information)) break;
      along = change;
    }
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      for (Eigen::Index i = 0; i < along.size(); ++i) jacobian(i, k) += (along[i] - before[i]) * direction[k];
    }
  }
  return jacobian;
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
  Eigen::MatrixXd jacobian = functions.central_jacobian(z, residuals);
  Hypothesis copy = hypothesis;
  Eigen::VectorXd width(count);  // of the prior: units in which what is not known at all has the variance 1
  for (Eigen::Index k = 0; k < count; ++k) {
    const Variable& variable = result.variables[static_cast<std::size_t>(k)];
    width[k] = prior_width(variable, value_of(copy, variable));
    for (Eigen::Index i = 0; i < jacobian.rows(); ++i) jacobian(i, k) *= width[k];
  }
  const double variance = variance_of_residuals(jacobian, products_of_gradients(functions, residuals, jacobian));
  jacobian = with_wide_differences(functions, z, width, std::move(jacobian), variance);
  Eigen::MatrixXd hessian = transposed_product(jacobian, jacobian);
  Eigen::MatrixXd gradients = products_of_gradients(functions, residuals, jacobian);

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
