// Nonlinear least squares: fits a few parameters to many residuals, with bounds, robust losses and the covariance of
// the estimate.
//
// Levenberg-Marquardt on the normal equations, scaled to unit diagonal; damping by Nielsen ("Damping parameter in
// Marquardt's method", IMM-REP-1999-05), which ends as Gauss-Newton. Robust losses by iterated weights. At a face of
// the box the parameters that want to leave it are held and the rest is projected. Cost of an iteration: one Jacobian,
// m n^2 for m residuals and n parameters, and n^3.
//
//   const auto residuals = [&](const Eigen::VectorXd& p) -> Eigen::VectorXd { return model(p) - measured; };
//   const auto fit = surefoot::least_squares(residuals, start);
//   // fit.x, and fit.covariance.diagonal().cwiseSqrt(): how well each parameter is known
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
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

struct LeastSquaresOptions {
  std::optional<Box<Eigen::Dynamic>> box = {};  // where parameters may be; none: everywhere
  Loss loss = Loss::squared;
  double loss_scale = 1;  // where a robust loss begins to bend, about twice the usual residual [unit of the residuals]
  int max_iterations = 100;
  double tol_gradient = 1e-10;  // largest cosine between the residuals and a column of the Jacobian
  double tol_step = 1e-10;      // length of a step [length of the parameters]
  double tol_cost = 1e-14;      // decrease of the cost in a step [cost]
  bool covariance = true;       // false: saves the last Jacobian; covariance, deviation, rank and held say nothing
};

enum class LeastSquaresStop : std::uint8_t { gradient, step, cost, max_iterations };

struct LeastSquaresResult {
  Eigen::VectorXd x;
  double cost = 0;  // half the sum of the losses
  Eigen::VectorXd residuals;
  LeastSquaresStop reason = LeastSquaresStop::max_iterations;
  int iterations = 0;

  // How well the residuals determine the parameters. A parameter that is held at a face of the box has variance 0; one
  // that the residuals do not determine has an infinite variance, and its covariances are NaN.
  Eigen::MatrixXd covariance;
  double deviation = 0;    // estimated standard deviation of a residual; infinite if there are not more than parameters
  Eigen::Index rank = 0;   // how many combinations of the parameters that are not held are determined
  std::vector<bool> held;  // by parameter, at a face of the box
};

namespace detail {

// A fit under way.
template <Residuals F, JacobianFunction J>
class LeastSquaresFit {
 public:
  LeastSquaresFit(const F& function, const J& jacobian, Eigen::VectorXd start, const LeastSquaresOptions& options)
      : function_(function), jacobian_(jacobian), options_(options), x_(std::move(start)) {
    if (x_.size() == 0 || !x_.allFinite()) {
      throw OptimizeError("least_squares: the start must have at least one parameter and be finite");
    }
    if (options_.box && (options_.box->size() != x_.size() || !options_.box->contains(x_))) {
      throw OptimizeError("least_squares: the start must lie in the box and have its dimension");
    }
    if (!(options_.loss_scale > 0)) throw OptimizeError("LeastSquaresOptions: loss_scale must be positive");
    residuals_ = function_(x_);
    if (residuals_.size() == 0 || !residuals_.allFinite()) {
      throw OptimizeError("least_squares: the residuals at the start must be finite and at least one; got " +
                          std::to_string(residuals_.size()));
    }
    cost_ = cost(residuals_);
  }

  LeastSquaresResult run() {
    LeastSquaresStop reason = LeastSquaresStop::max_iterations;
    int iteration = 0;
    linearise();
    for (; iteration < options_.max_iterations; ++iteration) {
      if (const auto ended = improve()) {
        reason = *ended;
        break;
      }
      if (options_.covariance || iteration + 1 < options_.max_iterations) linearise();
    }
    LeastSquaresResult result{.x = x_,
                              .cost = cost_,
                              .residuals = residuals_,
                              .reason = reason,
                              .iterations = iteration,
                              .covariance = {},
                              .held = held_};
    if (options_.covariance) estimate_covariance(result);
    return result;
  }

 private:
  double cost(const Eigen::VectorXd& residuals) const {
    double sum = 0;
    for (const double r : residuals) sum += loss_terms(options_.loss, r / options_.loss_scale).rho;
    return 0.5 * options_.loss_scale * options_.loss_scale * sum;
  }

  // Gradient and Gauss-Newton matrix of the cost at x_, and which parameters are held.
  void linearise() {
    slopes_ = jacobian_(x_);
    if (slopes_.rows() != residuals_.size() || slopes_.cols() != x_.size() || !slopes_.allFinite()) {
      throw OptimizeError(
          "least_squares: the Jacobian must be finite with one row per residual and one column per parameter");
    }
    Eigen::VectorXd weights(residuals_.size());
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      weights[i] = loss_terms(options_.loss, residuals_[i] / options_.loss_scale).weight;
    }
    const Eigen::VectorXd pull = weights.cwiseProduct(residuals_);
    gradient_ = slopes_.transpose() * pull;
    hessian_ = slopes_.transpose() * weights.asDiagonal() * slopes_;
    pull_norm_ = pull.norm();
    held_.assign(static_cast<std::size_t>(x_.size()), false);
    if (!options_.box) return;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      held_[static_cast<std::size_t>(i)] = (x_[i] <= options_.box->low()[i] && gradient_[i] >= 0) ||
                                           (x_[i] >= options_.box->high()[i] && gradient_[i] <= 0);
    }
  }

  std::vector<Eigen::Index> free_parameters() const {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (!held_[static_cast<std::size_t>(i)]) free.push_back(i);
    }
    return free;
  }

  // Steps until one makes the cost smaller; says so when there is nothing left to gain.
  std::optional<LeastSquaresStop> improve() {
    const std::vector<Eigen::Index> free = free_parameters();
    const Eigen::VectorXd norms = slopes_.colwise().norm().transpose();
    double steepest = 0;
    for (const Eigen::Index i : free) {
      if (norms[i] > 0 && pull_norm_ > 0)
        steepest = std::max(steepest, std::abs(gradient_[i]) / (norms[i] * pull_norm_));
    }
    if (steepest <= options_.tol_gradient) return LeastSquaresStop::gradient;

    const Eigen::MatrixXd hessian = hessian_(free, free);
    const Eigen::VectorXd gradient = gradient_(free);
    const Eigen::VectorXd scale = hessian.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
    const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
    while (true) {
      Eigen::MatrixXd damped = scaled;
      damped.diagonal().array() += damping_;
      Eigen::VectorXd next = x_;
      next(free) -= scale.cwiseProduct(damped.ldlt().solve(scale.cwiseProduct(gradient)));
      if (options_.box) next = options_.box->clamp(next);
      const Eigen::VectorXd step = next - x_;
      if (!(step.norm() > options_.tol_step * (x_.norm() + options_.tol_step))) return LeastSquaresStop::step;
      const Eigen::VectorXd residuals = function_(next);
      const double next_cost = residuals.size() == residuals_.size() && residuals.allFinite()
                                   ? cost(residuals)
                                   : std::numeric_limits<double>::infinity();
      if (next_cost < cost_) {
        const double gain = cost_ - next_cost;
        const double expected = -(gradient_.dot(step) + 0.5 * step.dot(hessian_ * step));
        const double ratio = expected > 0 ? gain / expected : 1;
        damping_ *= std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3));
        growth_ = 2;
        const bool done = gain <= options_.tol_cost * cost_;
        x_ = next;
        residuals_ = residuals;
        cost_ = next_cost;
        if (!done) return std::nullopt;
        if (options_.covariance) linearise();
        return LeastSquaresStop::cost;
      }
      damping_ *= growth_;
      growth_ *= 2;
    }
  }

  // The asymptotic covariance of an M-estimate (Huber 1981, section 7.6); for the squared loss the usual one, the
  // variance of a residual times the inverse of J^T J.
  void estimate_covariance(LeastSquaresResult& result) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::vector<Eigen::Index> free = free_parameters();
    double squares = 0, slope = 0;
    for (const double r : residuals_) {
      const LossTerms terms = loss_terms(options_.loss, r / options_.loss_scale);
      squares += terms.weight * r * terms.weight * r;
      slope += terms.slope;
    }
    const double spare = static_cast<double>(residuals_.size()) - static_cast<double>(free.size());
    slope /= static_cast<double>(residuals_.size());
    result.deviation = spare > 0 && slope > 0 ? std::sqrt(squares / spare) / slope : infinity;

    result.covariance = Eigen::MatrixXd::Zero(x_.size(), x_.size());
    if (free.empty()) return;

    const Eigen::MatrixXd slopes = slopes_(Eigen::all, free);
    const Eigen::VectorXd norms = slopes.colwise().norm().transpose();
    const Eigen::VectorXd scale = norms.unaryExpr([](double norm) { return norm > 0 ? 1 / norm : 1.0; });
    const Eigen::MatrixXd scaled = slopes * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled.transpose() * scaled);
    const auto count = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
    std::vector<bool> open(free.size(), false);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::VectorXd axis = solver.eigenvectors().col(k);
      if (solver.eigenvalues()[k] > 1e-12 * static_cast<double>(count)) {
        ++result.rank;
        inverse += axis * axis.transpose() / solver.eigenvalues()[k];
      } else {
        for (Eigen::Index i = 0; i < count; ++i) {
          if (std::abs(axis[i]) > 1e-4) open[static_cast<std::size_t>(i)] = true;
        }
      }
    }
    inverse = scale.asDiagonal() * inverse * scale.asDiagonal();
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b < count; ++b) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        double value = inverse(a, b) * result.deviation * result.deviation;
        if (open[i] || open[j]) value = a == b ? infinity : std::numeric_limits<double>::quiet_NaN();
        result.covariance(free[i], free[j]) = value;
      }
    }
  }

  const F& function_;
  const J& jacobian_;
  const LeastSquaresOptions& options_;
  Eigen::VectorXd x_, residuals_;
  double cost_ = 0;
  Eigen::MatrixXd slopes_;  // the Jacobian at x_
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd hessian_;
  double pull_norm_ = 0;  // of the weighted residuals
  std::vector<bool> held_;
  double damping_ = 1e-3;
  double growth_ = 2;
};

}  // namespace detail

/// Minimises half the sum of the losses of `residuals`, from `start`. Throws OptimizeError if the start is outside the
/// box or its residuals are not finite; later points where they are not are stepped back from.
template <Residuals F, JacobianFunction J>
LeastSquaresResult least_squares(const F& residuals, const Eigen::VectorXd& start, const LeastSquaresOptions& options,
                                 const J& jacobian) {
  return detail::LeastSquaresFit(residuals, jacobian, start, options).run();
}

/// The same with the Jacobian by central differences.
template <Residuals F>
LeastSquaresResult least_squares(const F& residuals, const Eigen::VectorXd& start,
                                 const LeastSquaresOptions& options = {}) {
  return least_squares(residuals, start, options,
                       [&](const Eigen::VectorXd& x) { return numeric_jacobian(residuals, x, options.box); });
}

}  // namespace surefoot
