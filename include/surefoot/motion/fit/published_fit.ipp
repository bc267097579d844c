// Definitions of surefoot/motion/fit/published_fit.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/fit/published_fit.hpp"
#include "surefoot/optimize/least_squares_loop.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const PublishedFitOptions& options) {
  const auto demand = [](bool condition, const char* what, double value) {
    if (!condition) throw MotionError(std::string("PublishedFitOptions: ") + what + ", got " + std::to_string(value));
  };
  demand(options.heading_tolerance >= 0, "heading_tolerance must not be negative", options.heading_tolerance);
  demand(options.heading_weight >= 0 && options.heading_weight <= 1, "heading_weight must be in [0, 1]",
         options.heading_weight);
}

SUREFOOT_INLINE double published_fitness(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                                         const PublishedFitOptions& options) {
  const FinalPoseError error = final_pose_error(model, sequences, options.heading_tolerance);
  if (!std::isfinite(error.position)) return std::numeric_limits<double>::infinity();
  const double heading = std::isnan(error.heading) ? 0 : error.heading;
  return (1 - options.heading_weight) * error.position + options.heading_weight * heading;
}

namespace detail {

SUREFOOT_INLINE CmaEsOptions published_search(const PublishedFitOptions& options) {
  CmaEsOptions search{.box_sigma = 0.05, .max_evaluations = options.max_evaluations};
  search.tolerances.fun = 1e-6;  // [m, rad]
  search.tolerances.x = 1e-4;    // [start sigmas]
  return search;
}

SUREFOOT_INLINE bool determined(const AnyMotionModel& model, std::span<const WalkSequence> sequences) {
  Eigen::Index readings = 0;
  for (const WalkSequence& sequence : sequences) {
    readings += std::isfinite(sequence.poses(2, sequence.cycles() - 1)) ? 3 : 2;
  }
  return 4 * readings >= 5 * model.parameter_count();
}

/// Three residuals for each sequence, weighed: final position, and the heading beyond the tolerance.
class FinalPoseResiduals {
 public:
  FinalPoseResiduals(const AnyMotionModel& model, std::span<const WalkSequence> sequences, double tolerance,
                     double position_weight, double heading_weight)
      : model_(model),
        sequences_(sequences),
        tolerance_(tolerance),
        position_(position_weight),
        heading_(heading_weight),
        width_(model.parameter_box().high() - model.parameter_box().low()) {}

  Eigen::VectorXd operator()(const Eigen::VectorXd& parameters) const {
    Eigen::VectorXd result(3 * static_cast<Eigen::Index>(sequences_.size()));
    Eigen::Matrix3Xd moved;
    Eigen::Index row = 0;
    for (const WalkSequence& sequence : sequences_) {
      model_.displacements(parameters, sequence.commands, sequence.command_before, moved);
      const Vec<3> error = off(compose(moved), sequence);
      for (int i = 0; i < 3; ++i) result[row++] = (i < 2 ? position_ : heading_) * error[i];
    }
    return result;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& parameters) const {
    const Eigen::Index n = parameters.size();
    Eigen::MatrixXd result(3 * static_cast<Eigen::Index>(sequences_.size()), n);
    Eigen::VectorXd shifted = parameters;
    Eigen::Matrix3Xd moved, above, below;
    Eigen::Index row = 0;
    for (const WalkSequence& sequence : sequences_) {
      model_.displacements(parameters, sequence.commands, sequence.command_before, moved);
      const double beyond = off(compose(moved), sequence)[2];
      for (Eigen::Index k = 0; k < n; ++k) {
        const double step = 1e-5 * width_[k];  // displacements are nearly linear in the parameters
        shifted[k] = parameters[k] + step;
        model_.displacements(shifted, sequence.commands, sequence.command_before, above);
        shifted[k] = parameters[k] - step;
        model_.displacements(shifted, sequence.commands, sequence.command_before, below);
        shifted[k] = parameters[k];
        const Vec<3> slope = final_pose_slope(moved, above, below, 1 / (2 * step));
        for (int i = 0; i < 2; ++i) result(row + i, k) = position_ * slope[i];
        result(row + 2, k) = beyond != 0 ? heading_ * slope[2] : 0;
      }
      row += 3;
    }
    return result;
  }

 private:
  /// Predicted less measured, of the heading only what is beyond the tolerance (or not measured: nothing).
  Vec<3> off(const Pose2& predicted, const WalkSequence& sequence) const {
    const auto measured = sequence.poses.col(sequence.cycles() - 1);
    const double angle = std::isfinite(measured[2]) ? wrap_angle(predicted.angle - measured[2]) : 0;
    const double beyond = std::max(0.0, std::abs(angle) - tolerance_);
    return {predicted.x - measured[0], predicted.y - measured[1], angle < 0 ? -beyond : beyond};
  }

  /// Of the composed pose, where the displacements change by (above - below) per_unit.
  static Vec<3> final_pose_slope(const Eigen::Matrix3Xd& moved, const Eigen::Matrix3Xd& above,
                                 const Eigen::Matrix3Xd& below, double per_unit) {
    double angle = 0, x = 0, y = 0, turned = 0;
    for (Eigen::Index i = 0; i < moved.cols(); ++i) {
      const double c = std::cos(angle), s = std::sin(angle);
      const double dx = per_unit * (above(0, i) - below(0, i)), dy = per_unit * (above(1, i) - below(1, i));
      x += c * dx - s * dy - turned * (s * moved(0, i) + c * moved(1, i));
      y += s * dx + c * dy + turned * (c * moved(0, i) - s * moved(1, i));
      turned += per_unit * (above(2, i) - below(2, i));
      angle += moved(2, i);
    }
    return {x, y, turned};
  }

  const AnyMotionModel& model_;
  std::span<const WalkSequence> sequences_;
  double tolerance_, position_, heading_;
  Eigen::VectorXd width_;
};

SUREFOOT_INLINE AnyPublishedFit published_steps(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                                                const PublishedFitOptions& options) {
  constexpr double least = 1e-4;  // root mean squares below are as good as this [m, rad]
  constexpr double gain = 1e-6;   // as where CMA-ES ends [m, rad]
  constexpr int most = 100;       // changes of the weights; some ten are usual
  const Box<Eigen::Dynamic>& range = start.parameter_box();
  LeastSquaresOptions inner{.box = range, .max_iterations = 3};
  inner.covariance = false;
  AnyPublishedFit fit{.model = start.with_parameters(range.clamp(start.parameters()))};
  fit.fitness = published_fitness(fit.model, sequences, options);
  const auto count = static_cast<double>(sequences.size());
  for (int i = 0; i < most; ++i) {
    const FinalPoseError at = final_pose_error(fit.model, sequences, options.heading_tolerance);
    const double heading = std::isnan(at.heading) ? least : std::max(at.heading, least);
    const FinalPoseResiduals residuals(fit.model, sequences, options.heading_tolerance,
                                       std::sqrt((1 - options.heading_weight) / (count * std::max(at.position, least))),
                                       std::sqrt(options.heading_weight / (count * heading)));
    const LeastSquaresResult found =
        minimise_squares([&](const Eigen::VectorXd& p) { return residuals(p); }, fit.model.parameters(), inner,
                         [&](const Eigen::VectorXd& p) { return residuals.jacobian(p); })
            .result;
    const AnyMotionModel next = fit.model.with_parameters(found.x);
    const double fitness = published_fitness(next, sequences, options);
    ++fit.evaluations;
    if (!(fitness < fit.fitness)) break;
    const bool settled = fit.fitness - fitness < gain;
    fit.model = next;
    fit.fitness = fitness;
    if (settled) break;
  }
  fit.error = final_pose_error(fit.model, sequences, options.heading_tolerance);
  return fit;
}

}  // namespace detail

}  // namespace surefoot
