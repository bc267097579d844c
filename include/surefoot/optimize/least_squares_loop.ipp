// Definitions of surefoot/optimize/least_squares_loop.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/least_squares_loop.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/robust_loss.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const LeastSquaresOptions& options) {
  const auto demand = [](bool condition, const char* sentence) {
    if (!condition) throw OptimizeError(std::string("LeastSquaresOptions: ") + sentence);
  };
  demand(options.loss_scale > 0, "loss_scale must be positive");
  demand(options.max_iterations >= 0, "max_iterations must not be negative");
  demand(options.tol_gradient >= 0 && options.tol_step >= 0 && options.tol_cost >= 0,
         "tol_gradient, tol_step and tol_cost must not be negative");
  demand(options.secant_steps >= 0, "secant_steps must not be negative");
  demand(options.max_seconds >= 0, "max_seconds must not be negative");
}

namespace detail {

// A fit under way.
class LeastSquaresFit {
 public:
  LeastSquaresFit(const VectorFunction& function, const MatrixFunction& jacobian, Eigen::VectorXd start,
                  const LeastSquaresOptions& options)
      : function_(function), jacobian_(jacobian), options_(options), x_(std::move(start)) {
    if (x_.size() == 0 || !all_finite(x_)) {
      throw OptimizeError("least_squares: the start must have at least one parameter and be finite");
    }
    if (options_.box && (options_.box->size() != x_.size() || !options_.box->contains(x_))) {
      throw OptimizeError("least_squares: the start must lie in the box and have its dimension");
    }
    residuals_ = function_(x_);
    if (residuals_.size() == 0 || !all_finite(residuals_)) {
      throw OptimizeError("least_squares: the residuals at the start must be finite and at least one; got " +
                          std::to_string(residuals_.size()));
    }
    cost_ = cost(residuals_);
  }

  LeastSquaresEnd run() {
    LeastSquaresStop reason = LeastSquaresStop::max_iterations;
    int iteration = 0;
    linearise();
    for (; iteration < options_.max_iterations; ++iteration) {
      if (iteration > 0 && seconds() >= options_.max_seconds) {
        reason = LeastSquaresStop::time_budget;
        break;
      }
      if (const auto ended = improve()) {
        reason = *ended;
        break;
      }
      if (options_.on_progress) options_.on_progress(iteration + 1, cost_);
      const bool last = iteration + 1 == options_.max_iterations;
      if (linearised_) continue;
      if (!last && jacobian_holds_ && secant_steps_ < options_.secant_steps) {
        update_by_secant();
      } else if (!last) {
        linearise();
      }
    }
    if (options_.covariance && (!linearised_ || secant_steps_ > 0)) linearise();
    LeastSquaresResult result{.x = x_,
                              .cost = cost_,
                              .residuals = residuals_,
                              .reason = reason,
                              .iterations = iteration,
                              .covariance = {},
                              .active_bound = active_bound_};
    return {std::move(result), std::move(jacobian_at_x_)};
  }

 private:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }

  double cost(const Eigen::VectorXd& residuals) const {
    double sum = 0;
    for (const double r : residuals) sum += loss_terms(options_.loss, r / options_.loss_scale).rho;
    return 0.5 * options_.loss_scale * options_.loss_scale * sum;
  }

  // What the last step showed, put into the Jacobian (Broyden, "A class of methods for solving nonlinear simultaneous
  // equations", Mathematics of Computation 19, 1965) in the norm of its columns, so that units do not matter.
  void update_by_secant() {
    ++secant_steps_;
    Eigen::VectorXd direction(x_.size());
    double length = 0;
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      direction[j] = hessian_(j, j) * last_step_[j];
      length += direction[j] * last_step_[j];
    }
    const Eigen::VectorXd expected = product(jacobian_at_x_, last_step_);
    for (Eigen::Index j = 0; length > 0 && j < x_.size(); ++j) {
      const double share = direction[j] / length;
      for (Eigen::Index i = 0; i < residuals_.size(); ++i) {
        jacobian_at_x_(i, j) += (last_change_[i] - expected[i]) * share;
      }
    }
    take_jacobian();
  }

  void linearise() {
    jacobian_at_x_ = jacobian_(x_);
    secant_steps_ = 0;
    take_jacobian();
  }

  // Gradient and Gauss-Newton matrix of the cost at x_, and which parameters are at an active bound.
  void take_jacobian() {
    linearised_ = true;
    if (jacobian_at_x_.rows() != residuals_.size() || jacobian_at_x_.cols() != x_.size() ||
        !all_finite(jacobian_at_x_)) {
      throw OptimizeError(
          "least_squares: the Jacobian must be finite with one row per residual and one column per parameter");
    }
    Eigen::VectorXd weights(residuals_.size()), weighted = residuals_;
    for (Eigen::Index i = 0; i < weighted.size(); ++i) {
      weights[i] = loss_terms(options_.loss, residuals_[i] / options_.loss_scale).weight;
      weighted[i] *= weights[i];
    }
    gradient_ = transposed_product(jacobian_at_x_, weighted);
    hessian_ = weighted_square(jacobian_at_x_, weights);
    weighted_norm_ = norm(weighted);
    active_bound_.assign(static_cast<std::size_t>(x_.size()), false);
    if (!options_.box) return;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      active_bound_[static_cast<std::size_t>(i)] = (x_[i] <= options_.box->low()[i] && gradient_[i] >= 0) ||
                                                   (x_[i] >= options_.box->high()[i] && gradient_[i] <= 0);
    }
  }

  std::vector<Eigen::Index> free_parameters() const {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (!active_bound_[static_cast<std::size_t>(i)]) free.push_back(i);
    }
    return free;
  }

  // Of the free parameters: what scales the Gauss-Newton matrix to a diagonal of ones, that matrix and the gradient.
  struct ScaledStep {
    Eigen::VectorXd scale, gradient;
    Eigen::MatrixXd hessian;
  };

  ScaledStep scale_to_unit_diagonal(const std::vector<Eigen::Index>& free) const {
    const auto count = static_cast<Eigen::Index>(free.size());
    ScaledStep result{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::MatrixXd(count, count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index at = free[static_cast<std::size_t>(i)];
      const double d = hessian_(at, at);
      result.scale[i] = d > 0 ? 1 / std::sqrt(d) : 1.0;
      result.gradient[i] = result.scale[i] * gradient_[at];
      for (Eigen::Index j = 0; j < count; ++j) result.hessian(i, j) = hessian_(at, free[static_cast<std::size_t>(j)]);
    }
    result.hessian = scaled(result.scale, result.hessian);
    return result;
  }

  // Where a step with the present damping ends.
  Eigen::VectorXd damped_step(const std::vector<Eigen::Index>& free, const ScaledStep& scaled) const {
    Eigen::MatrixXd damped = scaled.hessian;
    for (Eigen::Index i = 0; i < damped.rows(); ++i) damped(i, i) += damping_;
    const Eigen::VectorXd step = solve_symmetric(damped, scaled.gradient);
    Eigen::VectorXd next = x_;
    for (Eigen::Index i = 0; i < step.size(); ++i) next[free[static_cast<std::size_t>(i)]] -= scaled.scale[i] * step[i];
    return options_.box ? options_.box->clamp(next) : next;
  }

  // The largest cosine between the residuals and a column of the Jacobian.
  double steepest(const std::vector<Eigen::Index>& free) const {
    double largest = 0;
    for (const Eigen::Index i : free) {
      const double length = column_norm(jacobian_at_x_, i);
      if (length > 0 && weighted_norm_ > 0)
        largest = std::max(largest, std::abs(gradient_[i]) / (length * weighted_norm_));
    }
    return largest;
  }

  // Steps until one makes the cost smaller; the reason to stop when there is nothing left to gain. What ends a fit must
  // be seen with a Jacobian that is no update.
  std::optional<LeastSquaresStop> improve() {
    const std::optional<LeastSquaresStop> ended = descend();
    if (!ended || secant_steps_ == 0) return ended;
    linearise();
    return *ended == LeastSquaresStop::cost ? std::nullopt : descend();
  }

  std::optional<LeastSquaresStop> descend() {
    const std::vector<Eigen::Index> free = free_parameters();
    if (steepest(free) <= options_.tol_gradient) return LeastSquaresStop::gradient;
    const ScaledStep scaled_step = scale_to_unit_diagonal(free);
    while (true) {
      const Eigen::VectorXd next = damped_step(free, scaled_step);
      Eigen::VectorXd step = next;
      for (Eigen::Index i = 0; i < step.size(); ++i) step[i] -= x_[i];
      if (!(norm(step) > options_.tol_step * (norm(x_) + options_.tol_step))) return LeastSquaresStop::step;
      Eigen::VectorXd residuals = function_(next);
      const double next_cost = residuals.size() == residuals_.size() && all_finite(residuals)
                                   ? cost(residuals)
                                   : std::numeric_limits<double>::infinity();
      if (next_cost < cost_) {
        const bool done = take_step(next, std::move(step), std::move(residuals), next_cost);
        return done ? std::optional(LeastSquaresStop::cost) : std::nullopt;
      }
      if (secant_steps_ > 0) return LeastSquaresStop::step;  // an update may have led astray
      damping_ *= growth_;
      growth_ *= 2;
    }
  }

  // True if it gained next to nothing.
  bool take_step(const Eigen::VectorXd& next, Eigen::VectorXd step, Eigen::VectorXd residuals, double next_cost) {
    constexpr double least_ratio = 0.25;  // of gain to expected gain, below which a Jacobian does not hold any more
    const double gain = cost_ - next_cost;
    const Eigen::VectorXd bent = product(hessian_, step);
    const double expected =
        -(dot(gradient_.data(), step.data(), step.size()) + 0.5 * dot(step.data(), bent.data(), step.size()));
    const double ratio = expected > 0 ? gain / expected : 1;
    damping_ *= std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3));
    growth_ = 2;
    const bool done = gain <= options_.tol_cost * cost_;
    last_change_ = residuals;
    for (Eigen::Index i = 0; i < residuals.size(); ++i) last_change_[i] -= residuals_[i];
    last_step_ = std::move(step);
    x_ = next;
    residuals_ = std::move(residuals);
    cost_ = next_cost;
    jacobian_holds_ = ratio >= least_ratio;
    linearised_ = false;
    return done;
  }

  const VectorFunction& function_;
  const MatrixFunction& jacobian_;
  const LeastSquaresOptions& options_;
  Eigen::VectorXd x_, residuals_;
  double cost_ = 0;
  Eigen::MatrixXd jacobian_at_x_;            // the Jacobian at x_, or an update of an earlier one
  int secant_steps_ = 0;                     // updates since the last Jacobian
  Eigen::VectorXd last_step_, last_change_;  // of the parameters, and of the residuals
  bool jacobian_holds_ = true;               // the last step gained what was expected
  bool linearised_ = false;                  // at x_
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd hessian_;
  double weighted_norm_ = 0;  // of the weighted residuals
  std::vector<bool> active_bound_;
  double damping_ = 1e-3;
  double growth_ = 2;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

SUREFOOT_INLINE LeastSquaresEnd minimise_squares(const VectorFunction& residuals, const Eigen::VectorXd& start,
                                                 const LeastSquaresOptions& options, const MatrixFunction& jacobian) {
  check(options);
  return LeastSquaresFit(residuals, jacobian, start, options).run();
}

}  // namespace detail

}  // namespace surefoot
