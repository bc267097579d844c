// Reasons for the end of a search, and the stop criteria of a descent of CMA-ES.
// Hansen: "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, appendix B.3.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot {

enum class StopReason : std::uint8_t {
  // of the whole search
  target_reached,
  max_evaluations,
  time_budget,
  stop_requested,
  // of a descent, hence also of a search whose last descent it was
  tol_x,                 // the distribution became narrow: converged
  tol_fun,               // the values became equal up to a tolerance: converged
  equal_values,          // the best values of many generations are the same: a plateau
  stagnation,            // neither best nor median values got better for long: usual with noise
  tol_x_up,              // the distribution grew far beyond its start: sigma was far too small, or no minimum exists
  condition,             // the covariance became numerically singular
  no_effect_axis,        // a step along one axis no longer changes the mean: the precision of double is reached
  no_effect_coordinate,  // a step in one coordinate no longer changes the mean: likewise
};

constexpr std::string_view to_string(StopReason reason) {
  constexpr std::string_view names[] = {"target reached", "max evaluations", "time budget",    "stop requested",
                                        "tol x",          "tol fun",         "equal values",   "stagnation",
                                        "tol x up",       "condition",       "no effect axis", "no effect coordinate"};
  return names[static_cast<std::size_t>(reason)];
}

/// Thresholds of the stop criteria; 0 (or infinity for the upper ones) switches one off.
struct CmaEsTolerances {
  double x = 1e-12;         // of all standard deviations [start sigmas]
  double x_up = 1e4;        // of any standard deviation [start sigmas]
  double fun = 1e-12;       // range of the last best values and of the last generation [unit of the objective]
  double condition = 1e14;  // of the covariance, checked every n generations
  bool stagnation = true;
};

namespace detail {

double median(std::deque<double>::const_iterator begin, std::deque<double>::const_iterator end);

// Whether the median of the newest 30 % is not better than that of the oldest 30 %.
inline bool stagnates(const std::deque<double>& values) {
  const auto third = static_cast<std::ptrdiff_t>(values.size() * 3 / 10);
  return median(values.end() - third, values.end()) >= median(values.begin(), values.begin() + third);
}

}  // namespace detail

/// Why the descent is over, if it is. Cost: n, now and then n^3.
std::optional<StopReason> converged(const CmaEsState& state, const CmaEsTolerances& tolerances);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es_stop.ipp"
#endif
