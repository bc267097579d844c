// Definitions of surefoot/optimize/cma_es_stop.hpp.
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

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/cma_es_stop.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE double median(std::deque<double>::const_iterator begin, std::deque<double>::const_iterator end) {
  std::vector<double> values(begin, end);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace surefoot::detail

namespace surefoot {

SUREFOOT_INLINE std::optional<StopReason> converged(const CmaEsState& state, const CmaEsTolerances& tolerances) {
  if (state.generation == 0) return std::nullopt;
  const Eigen::Index n = state.dimension();
  const auto deviation = [&](Eigen::Index i) { return std::sqrt(state.covariance(i, i)) * state.sigma; };
  double widest = deviation(0), farthest = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    widest = std::max(widest, deviation(i));
    farthest = std::max(farthest, std::abs(state.path[i]));
  }
  if (state.degenerate || !std::isfinite(state.sigma)) return StopReason::condition;
  if (widest < tolerances.x * state.start_sigma && farthest * state.sigma < tolerances.x * state.start_sigma) {
    return StopReason::tol_x;
  }
  if (widest > tolerances.x_up * state.start_sigma) return StopReason::tol_x_up;
  const auto axis = static_cast<Eigen::Index>(state.generation % static_cast<std::uint64_t>(n));
  bool axis_without_effect = true;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double at = state.mean[i];
    if (at == at + 0.2 * deviation(i)) return StopReason::no_effect_coordinate;
    if (at != at + 0.1 * state.sigma * state.factor(i, axis)) axis_without_effect = false;
  }
  if (axis_without_effect) return StopReason::no_effect_axis;

  const auto window = static_cast<std::ptrdiff_t>(10 + (30 * n + state.population - 1) / state.population);
  if (std::ssize(state.best_values) >= window) {
    const auto [least, most] = std::minmax_element(state.best_values.end() - window, state.best_values.end());
    if (*least == *most) return StopReason::equal_values;
    if (*most - *least < tolerances.fun && state.value_range < tolerances.fun) return StopReason::tol_fun;
  }
  if (tolerances.stagnation && state.generation % 10 == 0 && state.best_values.size() >= state.shortest_history() &&
      detail::stagnates(state.best_values) && detail::stagnates(state.median_values)) {
    return StopReason::stagnation;
  }
  if (state.generation % static_cast<std::uint64_t>(n) == 0 &&
      detail::condition_of_symmetric(state.covariance) > tolerances.condition) {
    return StopReason::condition;
  }
  return std::nullopt;
}

}  // namespace surefoot
