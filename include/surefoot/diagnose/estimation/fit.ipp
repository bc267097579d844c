// Definitions of surefoot/diagnose/estimation/fit.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/residuals.hpp"
#include "surefoot/optimize/least_squares.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Parallel serially() {
  return [](std::size_t count, const std::function<void(std::size_t)>& job) {
    for (std::size_t i = 0; i < count; ++i) job(i);
  };
}

SUREFOOT_INLINE double mean_loss(const Eigen::VectorXd& residuals, double robust) {
  if (residuals.size() == 0) return 0;
  double sum = 0;
  for (const double r : residuals) sum += robust * robust * loss_terms(Loss::huber, r / robust).rho;
  return sum / static_cast<double>(residuals.size());
}

SUREFOOT_INLINE Fit fit(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
                        const Parallel& parallel) {
  const FitFunctions functions(bound, start, problem, parallel);
  Fit result{.hypothesis = start};
  const Eigen::VectorXd z = functions.start();
  const Eigen::VectorXd first = functions.residuals(z);
  result.loss = mean_loss(first, problem.weighting.robust);
  if (!first.allFinite() || first.size() == 0) return result;
  result.ok = true;
  if (functions.variables().empty()) return result;
  LeastSquaresOptions options;
  options.box = functions.box();
  options.loss = Loss::huber;
  options.loss_scale = problem.weighting.robust;
  options.max_iterations = problem.max_iterations;
  options.tol_cost = problem.tolerance;
  options.tol_step = 1e-6;
  options.covariance = false;
  Eigen::VectorXd asked = z, there = first;  // the last point, whose residuals the Jacobian needs again
  const auto residuals = [&](const Eigen::VectorXd& x) -> const Eigen::VectorXd& {
    if (x != asked) {
      there = functions.residuals(x);
      asked = x;
    }
    return there;
  };
  const auto fitted = least_squares(residuals, z, options,
                                    [&](const Eigen::VectorXd& x) { return functions.jacobian(x, residuals(x)); });
  result.hypothesis = functions.at(fitted.x);
  result.loss = mean_loss(fitted.residuals, problem.weighting.robust);
  return result;
}

SUREFOOT_INLINE Hypothesis with_estimated_starts(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                 const std::vector<std::size_t>& recordings, FitProblem problem,
                                                 const Parallel& parallel) {
  if (!free_start(bound, recordings)) return hypothesis;
  problem.recordings = recordings;
  problem.free = Free::initial_only;
  return fit(bound, hypothesis, problem, parallel).hypothesis;
}

SUREFOOT_INLINE StandardErrors standard_errors(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                               const FitProblem& problem, const Parallel& parallel) {
  const FitFunctions functions(bound, hypothesis, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  StandardErrors result{functions.variables(), {}, {}};
  const auto count = static_cast<Eigen::Index>(result.variables.size());
  if (count == 0) return result;
  const Eigen::VectorXd residuals = functions.residuals(z);
  const Eigen::MatrixXd slopes = functions.jacobian(z, residuals);
  Eigen::MatrixXd hessian = slopes.transpose() * slopes, meat = Eigen::MatrixXd::Zero(count, count);
  const Eigen::VectorXd scale = hessian.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  double blocks = 0;
  for (std::size_t i = 0; i + 1 < functions.begin().size(); ++i) {
    const Eigen::Index from = functions.begin()[i], length = functions.begin()[i + 1] - from;
    const Eigen::Index parts = std::clamp<Eigen::Index>(length / 50, 1, 8);
    for (Eigen::Index part = 0; part < parts; ++part) {
      const Eigen::Index a = from + length * part / parts, b = from + length * (part + 1) / parts;
      const Eigen::VectorXd pull =
          scale.cwiseProduct(slopes.middleRows(a, b - a).transpose() * residuals.segment(a, b - a));
      meat += pull * pull.transpose();
      ++blocks;
    }
  }
  Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(count, count));
  Eigen::MatrixXd covariance = inverse * meat * inverse * (blocks / std::max(1.0, blocks - 1));
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
