// Nonlinear least squares: the fit of a few parameters to many residuals, with bounds, robust losses and the covariance
// of the estimate.
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
#include <functional>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/least_squares_loop.hpp"
#include "surefoot/optimize/numeric_jacobian.hpp"

namespace surefoot {

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
