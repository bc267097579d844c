// Definitions of surefoot/motion/fit/fit_model.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/fit/fit_model.hpp"
#include "surefoot/motion/fit/weighted_poses.hpp"
#include "surefoot/optimize/least_squares_loop.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const ModelFitOptions& options) {
  check(options.accuracy);
  if (!(options.prior > 0)) {
    throw MotionError("ModelFitOptions: prior must be above 0, got " + std::to_string(options.prior));
  }
  if (options.max_iterations < 1) {
    throw MotionError("ModelFitOptions: max_iterations must be at least 1, got " +
                      std::to_string(options.max_iterations));
  }
}

SUREFOOT_INLINE AnyModelFit fit_model(std::span<const WalkSequence> sequences, const MotionNoise& noise,
                                      const ModelFitOptions& options, const AnyMotionModel& start) {
  constexpr double negligible_change = 1e-6;  // [widths of the parameters' ranges]
  constexpr double huber_scale = 2.5;         // where huber begins to bend [standard deviations]
  check(options);
  check(sequences);
  const Box<Eigen::Dynamic>& range = start.parameter_box();
  LeastSquaresOptions inner{.box = range, .loss = options.loss, .loss_scale = huber_scale, .max_iterations = 15};
  inner.tol_step = 1e-9;
  inner.covariance = false;
  const auto weighted = [&](const AnyMotionModel& at) {
    return detail::WeightedPoses(at, noise, options.accuracy, options.prior, sequences);
  };
  AnyModelFit fit{.model = start.with_parameters(range.clamp(start.parameters()))};
  for (int i = 0; i < options.max_iterations && !fit.converged; ++i) {
    const detail::WeightedPoses poses = weighted(fit.model);
    const LeastSquaresResult result =
        detail::minimise_squares([&](const Eigen::VectorXd& p) { return poses.residuals(p); }, fit.model.parameters(),
                                 inner, [&](const Eigen::VectorXd& p) { return poses.jacobian(p); })
            .result;
    double change = 0;  // [widths of the parameters' ranges]
    for (Eigen::Index k = 0; k < result.x.size(); ++k) {
      const double width = range.high()[k] - range.low()[k];
      change = std::max(change, std::abs((result.x[k] - fit.model.parameters()[k]) / width));
    }
    fit.model = fit.model.with_parameters(result.x);
    fit.cost = result.cost;
    fit.converged = change < negligible_change;
  }
  const Eigen::MatrixXd jacobian = weighted(fit.model).jacobian(fit.model.parameters());
  fit.covariance = detail::invert_symmetric(detail::product(detail::transposed(jacobian), jacobian));
  return fit;
}

}  // namespace surefoot
