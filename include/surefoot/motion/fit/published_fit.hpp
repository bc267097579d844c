// The calibration as it was published: CMA-ES on a weighted average of the errors of final positions and headings.
// Hofer and Rouxel, "An Operational Method Toward Efficient Walk Control Policies for Humanoid Robots", ICAPS 2017,
// section 4. Needs no idea of the noise; sees final poses only. Cost: one displacement per cycle and evaluation, some
// thousand evaluations.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <stop_token>
#include <utility>

#include "surefoot/core/executor.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/walk_sequence.hpp"
#include "surefoot/optimize/cma_es.hpp"

namespace surefoot {

struct PublishedFitOptions {
  double heading_tolerance = std::numbers::pi / 6;  // errors below count as none: headings are read off a clock [rad]
  double heading_weight = 0.5;  // of the heading's error [rad], one minus that of the position's [m]
  std::uint64_t max_evaluations = 100'000;
};

template <MotionModel M>
struct PublishedFit {
  M model;
  double fitness = 0;
  FinalPoseError error;  // over the sequences it was fitted to, with that tolerance
  std::uint64_t evaluations = 0;
};

/// Weighted average of the root mean square errors of final position [m] and heading [rad].
template <MotionModel M>
double published_fitness(const M& model, std::span<const WalkSequence> sequences,
                         const PublishedFitOptions& options = {}) {
  const FinalPoseError error = final_pose_error(model, sequences, options.heading_tolerance);
  if (!std::isfinite(error.position)) return std::numeric_limits<double>::infinity();
  const double heading = std::isnan(error.heading) ? 0 : error.heading;
  return (1 - options.heading_weight) * error.position + options.heading_weight * heading;
}

/// Minimises published_fitness over the ranges of the parameters, from the default model on. Throws MotionError if a
/// sequence cannot be used.
template <MotionModel M, Executor E>
PublishedFit<M> published_fit(std::span<const WalkSequence> sequences, const PublishedFitOptions& options,
                              const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  check(sequences);
  constexpr int n = M::parameter_count;
  const Box<n> box = parameter_box<M>();
  const auto fitness = [&](const Eigen::VectorXd& p) {
    return published_fitness(M::from_parameters(Vec<n>(p)), sequences, options);
  };
  CmaEsOptions search{.box_sigma = 0.05, .max_evaluations = options.max_evaluations};
  search.tolerances.fun = 1e-6;
  search.tolerances.x = 1e-4;
  const CmaEsResult found = cma_es(fitness, Eigen::VectorXd(M().parameters()),
                                   Box<Eigen::Dynamic>(Eigen::VectorXd(box.low()), Eigen::VectorXd(box.high())), search,
                                   executor, seed, std::move(stop));
  PublishedFit<M> fit{.model = M::from_parameters(Vec<n>(found.best)), .fitness = found.best_value, .error = {}};
  fit.error = final_pose_error(fit.model, sequences, options.heading_tolerance);
  fit.evaluations = found.evaluations;
  return fit;
}

}  // namespace surefoot
