// Nonlinear least squares: fits a few parameters to many residuals, with bounds, robust losses and the covariance of
// the estimate.
//
// Levenberg-Marquardt on the normal equations, scaled to unit diagonal; damping by Nielsen ("Damping parameter in
// Marquardt's method", IMM-REP-1999-05), which ends as Gauss-Newton. Robust losses by iterated weights. Parameters
// that want to leave the box stay at the active bound, the others are projected. Cost of an iteration: one Jacobian,
// m n^2 for m residuals and n parameters, and n^3.
//
//   const auto residuals = [&](const Eigen::VectorXd& p) -> Eigen::VectorXd { return model(p) - measured; };
//   const auto fit = surefoot::least_squares(residuals, start);
//   // fit.x, and fit.covariance.diagonal().cwiseSqrt(): how well each parameter is known
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/numeric_jacobian.hpp"
#include "surefoot/optimize/objective.hpp"
#include "surefoot/optimize/robust_loss.hpp"

namespace surefoot {

/// A function whose values are all to become small; their number must not change.
template <class F>
concept Residuals = requires(const F& residuals, const Eigen::VectorXd& x) {
  { residuals(x) } -> std::convertible_to<Eigen::VectorXd>;
};

/// The derivative of residuals: one row per residual, one column per parameter.
template <class F>
concept JacobianFunction = requires(const F& jacobian, const Eigen::VectorXd& x) {
  { jacobian(x) } -> std::convertible_to<Eigen::MatrixXd>;
};

/// The same with their types erased, so that the fit is compiled once.
using VectorFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
using MatrixFunction = std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>;

struct LeastSquaresOptions {
  std::optional<Box<Eigen::Dynamic>> box = {};  // where parameters may be; none: everywhere
  Loss loss = Loss::squared;
  double loss_scale = 1;  // where a robust loss begins to bend, about twice the usual residual [unit of the residuals]
  int max_iterations = 100;
  double tol_gradient = 1e-10;  // largest cosine between the residuals and a column of the Jacobian
  double tol_step = 1e-10;      // length of a step [length of the parameters]
  double tol_cost = 1e-14;      // decrease of the cost in a step [cost]
  double max_seconds = std::numeric_limits<double>::infinity();  // wall clock [s]
  bool covariance = true;  // false: saves the last Jacobian; covariance, deviation, rank and active_bound are not set

  /// Called after every iteration with its number, from 1 on, and the cost that it reached.
  std::function<void(int iteration, double cost)> on_progress = {};
};

/// Throws OptimizeError, naming the option, unless all of them make sense.
void check(const LeastSquaresOptions& options);

enum class LeastSquaresStop : std::uint8_t { gradient, step, cost, max_iterations, time_budget };

struct LeastSquaresResult {
  Eigen::VectorXd x;
  double cost = 0;  // half the sum of the losses
  Eigen::VectorXd residuals;
  LeastSquaresStop reason = LeastSquaresStop::max_iterations;
  int iterations = 0;

  // How well the residuals determine the parameters. A parameter at an active bound has variance 0; one
  // that the residuals do not determine has an infinite variance, and its covariances are NaN.
  Eigen::MatrixXd covariance;
  double deviation = 0;   // estimated standard deviation of a residual; infinite if there are not more than parameters
  Eigen::Index rank = 0;  // how many combinations of the other parameters are determined
  std::vector<bool> active_bound;  // by parameter: it wants to leave the box
};

namespace detail {

LeastSquaresResult least_squares(const VectorFunction& residuals, const Eigen::VectorXd& start,
                                 const LeastSquaresOptions& options, const MatrixFunction& jacobian);

}  // namespace detail

/// Minimises half the sum of the losses of `residuals`, from `start`. Throws OptimizeError if the start is outside the
/// box or its residuals are not finite; later points where they are not are stepped back from.
template <Residuals F, JacobianFunction J>
LeastSquaresResult least_squares(const F& residuals, const Eigen::VectorXd& start, const LeastSquaresOptions& options,
                                 const J& jacobian) {
  return detail::least_squares(std::cref(residuals), start, options, std::cref(jacobian));
}

/// The same with the Jacobian by central differences.
template <Residuals F>
LeastSquaresResult least_squares(const F& residuals, const Eigen::VectorXd& start,
                                 const LeastSquaresOptions& options = {}) {
  const VectorFunction function = std::cref(residuals);
  return detail::least_squares(function, start, options,
                               [&](const Eigen::VectorXd& x) { return numeric_jacobian(function, x, options.box); });
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/least_squares.ipp"
#endif
