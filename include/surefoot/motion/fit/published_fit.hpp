// Calibration as it was published: CMA-ES on a weighted average of the errors of final positions and headings.
// Hofer and Rouxel, "An Operational Method Toward Efficient Walk Control Policies for Humanoid Robots", ICAPS 2017,
// section 4. Needs no idea of the noise; sees final poses only. Cost: one displacement per cycle and evaluation, some
// thousand evaluations.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <span>
#include <stop_token>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/walk_sequence.hpp"
#include "surefoot/optimize/cma_es.hpp"

namespace surefoot {

struct PublishedFitOptions {
  double heading_tolerance = std::numbers::pi / 6;  // errors below count as none: headings are read off a clock [rad]
  double heading_weight = 0.5;  // of the heading's error [rad], one minus that of the position's [m]
  std::uint64_t max_evaluations = 100'000;
  bool steps_where_determined = false;  // Gauss-Newton steps to the same optimum, many times faster, where there are a
                                        // quarter more readings than parameters
};

/// Throws MotionError, naming the field.
void check(const PublishedFitOptions& options);

/// A fit of a model whose type is known at run time only.
struct AnyPublishedFit {
  AnyMotionModel model;
  double fitness = 0;
  FinalPoseError error = {};  // over the sequences it was fitted to, with that tolerance
  std::uint64_t evaluations = 0;
};

template <MotionModel M>
struct PublishedFit {
  M model;
  double fitness = 0;
  FinalPoseError error;  // over the sequences it was fitted to, with that tolerance
  std::uint64_t evaluations = 0;
};

/// Weighted average of the root mean square errors of final position [m] and heading [rad].
double published_fitness(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                         const PublishedFitOptions& options = {});

namespace detail {

CmaEsOptions published_search(const PublishedFitOptions& options);

/// Whether there are a quarter more coordinates of final poses than the model has parameters.
bool determined(const AnyMotionModel& model, std::span<const WalkSequence> sequences);

/// The local optimum of published_fitness below `start`, by least squares whose weights follow the two root mean
/// squares: a sum of roots is below each of its tangents in the squares (majorise and minimise).
AnyPublishedFit published_steps(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                                const PublishedFitOptions& options);

}  // namespace detail

/// Minimises published_fitness over the ranges of the parameters, from `start` on. Throws MotionError if a sequence
/// cannot be used.
template <Executor E>
AnyPublishedFit published_fit(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                              const PublishedFitOptions& options, const E& executor, std::uint64_t seed,
                              std::stop_token stop = {}) {
  check(options);
  check(sequences);
  if (options.steps_where_determined && detail::determined(start, sequences)) {
    return detail::published_steps(start, sequences, options);
  }
  const auto fitness = [&](const Eigen::VectorXd& parameters) {
    return published_fitness(start.with_parameters(parameters), sequences, options);
  };
  const CmaEsResult found = cma_es(fitness, start.parameters(), start.parameter_box(),
                                   detail::published_search(options), executor, seed, std::move(stop));
  AnyPublishedFit fit{.model = start.with_parameters(found.best), .fitness = found.best_value};
  fit.error = final_pose_error(fit.model, sequences, options.heading_tolerance);
  fit.evaluations = found.evaluations;
  return fit;
}

/// The same from the default model on.
template <MotionModel M, Executor E>
PublishedFit<M> published_fit(std::span<const WalkSequence> sequences, const PublishedFitOptions& options,
                              const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  const AnyPublishedFit fit = published_fit(AnyMotionModel(M()), sequences, options, executor, seed, std::move(stop));
  return {.model = fit.model.as<M>(), .fitness = fit.fitness, .error = fit.error, .evaluations = fit.evaluations};
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/published_fit.ipp"
#endif
