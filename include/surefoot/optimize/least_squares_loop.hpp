// The loop behind least_squares(): Levenberg-Marquardt for residuals and Jacobians of any type, without the covariance
// of the estimate.
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
  int secant_steps = 0;  // steps between Jacobians that change it by a rank-one update (Broyden 1965); for costly ones
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

struct LeastSquaresEnd {
  LeastSquaresResult result;  // its covariance, deviation and rank are not set
  Eigen::MatrixXd jacobian;   // at result.x, if options.covariance asks for it
};

LeastSquaresEnd minimise_squares(const VectorFunction& residuals, const Eigen::VectorXd& start,
                                 const LeastSquaresOptions& options, const MatrixFunction& jacobian);

}  // namespace detail

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/least_squares_loop.ipp"
#endif
