// Why a search ends, and the stop criteria of a descent of CMA-ES.
// Hansen: "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, appendix B.3.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
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

/// The numbers of the stop criteria; 0 (or infinity for the upper ones) switches one off.
struct CmaEsTolerances {
  double x = 1e-12;         // of all standard deviations [start sigmas]
  double x_up = 1e4;        // of any standard deviation [start sigmas]
  double fun = 1e-12;       // range of the last best values and of the last generation [unit of the objective]
  double condition = 1e14;  // of the covariance, checked every n generations
  bool stagnation = true;
};

namespace detail {

inline double median(std::deque<double>::const_iterator begin, std::deque<double>::const_iterator end) {
  std::vector<double> values(begin, end);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Whether the median of the newest 30 % is not better than that of the oldest 30 %.
inline bool stagnates(const std::deque<double>& values) {
  const auto third = static_cast<std::ptrdiff_t>(values.size() * 3 / 10);
  return median(values.end() - third, values.end()) >= median(values.begin(), values.begin() + third);
}

inline double condition(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, Eigen::EigenvaluesOnly);
  const double smallest = solver.eigenvalues().minCoeff();
  return smallest > 0 ? solver.eigenvalues().maxCoeff() / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace detail

/// Why the descent is over, if it is. Cost: n, now and then n^3.
inline std::optional<StopReason> converged(const CmaEsState& state, const CmaEsTolerances& tolerances) {
  if (state.generation == 0) return std::nullopt;
  const Eigen::Index n = state.dimension();
  const auto deviation = state.covariance.diagonal().array().sqrt() * state.sigma;
  if (state.degenerate || !std::isfinite(state.sigma)) return StopReason::condition;
  if (deviation.maxCoeff() < tolerances.x * state.start_sigma &&
      state.path.cwiseAbs().maxCoeff() * state.sigma < tolerances.x * state.start_sigma) {
    return StopReason::tol_x;
  }
  if (deviation.maxCoeff() > tolerances.x_up * state.start_sigma) return StopReason::tol_x_up;
  if ((state.mean.array() == state.mean.array() + 0.2 * deviation).any()) return StopReason::no_effect_coordinate;
  const auto axis = state.factor.col(static_cast<Eigen::Index>(state.generation % static_cast<std::uint64_t>(n)));
  if ((state.mean.array() == state.mean.array() + 0.1 * state.sigma * axis.array()).all()) {
    return StopReason::no_effect_axis;
  }

  const auto window = static_cast<std::ptrdiff_t>(10 + (30 * n + state.population - 1) / state.population);
  if (std::ssize(state.best_values) >= window) {
    const auto [least, most] = std::minmax_element(state.best_values.end() - window, state.best_values.end());
    if (*least == *most) return StopReason::equal_values;
    if (*most - *least < tolerances.fun && state.spread < tolerances.fun) return StopReason::tol_fun;
  }
  if (tolerances.stagnation && state.generation % 10 == 0 && state.best_values.size() >= state.shortest_history() &&
      detail::stagnates(state.best_values) && detail::stagnates(state.median_values)) {
    return StopReason::stagnation;
  }
  if (state.generation % static_cast<std::uint64_t>(n) == 0 &&
      detail::condition(state.covariance) > tolerances.condition) {
    return StopReason::condition;
  }
  return std::nullopt;
}

}  // namespace surefoot
