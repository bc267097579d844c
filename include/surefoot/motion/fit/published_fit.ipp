// Definitions of surefoot/motion/fit/published_fit.hpp.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/fit/published_fit.hpp"

namespace surefoot {

SUREFOOT_INLINE void check(const PublishedFitOptions& options) {
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

}  // namespace detail

}  // namespace surefoot
