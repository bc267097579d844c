// Definitions of surefoot/optimize/cma_es_core.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/optimize/cma_es_constants.hpp"
#include "surefoot/optimize/cma_es_core.hpp"
#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/objective.hpp"

namespace surefoot {

SUREFOOT_INLINE CmaEsState cma_es_start(const Eigen::VectorXd& start, double sigma, Eigen::Index population,
                                        std::uint64_t seed, std::uint64_t descent) {
  const Eigen::Index n = start.size();
  if (n == 0 || !all_finite(start)) {
    throw OptimizeError("cma_es: the start must have at least one dimension and finite coordinates");
  }
  if (!(sigma > 0) || !std::isfinite(sigma)) {
    throw OptimizeError("cma_es: sigma must be positive and finite, got " + std::to_string(sigma));
  }
  if (population < 4) {
    throw OptimizeError("cma_es: the population must be at least 4, got " + std::to_string(population));
  }
  return {.seed = seed,
          .descent = descent,
          .population = population,
          .mean = start,
          .sigma = sigma,
          .start_sigma = sigma,
          .covariance = Eigen::MatrixXd::Identity(n, n),
          .factor = Eigen::MatrixXd::Identity(n, n),
          .path_sigma = Eigen::VectorXd::Zero(n),
          .path = Eigen::VectorXd::Zero(n)};
}

SUREFOOT_INLINE CmaEsCore::CmaEsCore(CmaEsState state)
    : state_(std::move(state)),
      constants_(cma_es_constants(state_.dimension(), state_.population)),
      normal_(state_.dimension(), state_.population),
      step_(state_.dimension(), state_.population),
      candidates_(state_.dimension(), state_.population),
      order_(static_cast<std::size_t>(state_.population)),
      ranked_(order_.size()) {}

SUREFOOT_INLINE const Eigen::MatrixXd& CmaEsCore::ask() {
  if (asked_) return candidates_;
  const Eigen::Index n = state_.dimension();
  Rng rng(state_.seed, state_.descent, state_.generation);
  for (double& z : normal_.reshaped()) z = rng.normal();
  step_.setZero();
  for (Eigen::Index i = 0; i < state_.population; ++i) {
    auto step = step_.col(i);
    for (Eigen::Index j = 0; j < n; ++j) step.tail(n - j) += normal_(j, i) * state_.factor.col(j).tail(n - j);
  }
  candidates_.noalias() = state_.sigma * step_;
  candidates_.colwise() += state_.mean;
  asked_ = true;
  return candidates_;
}

SUREFOOT_INLINE void CmaEsCore::tell(std::span<const double> values) {
  if (!asked_ || static_cast<Eigen::Index>(values.size()) != state_.population) {
    throw OptimizeError("CmaEsCore::tell: needs one value for each of the " + std::to_string(state_.population) +
                        " candidates of the last ask()");
  }
  rank(values);
  move_mean();
  adapt_covariance();
  adapt_sigma();
  record_values();
  ++state_.generation;
  if (state_.generation % static_cast<std::uint64_t>(constants_.factor_gap) == 0) factorise();
  asked_ = false;
}

SUREFOOT_INLINE void CmaEsCore::rank(std::span<const double> values) {
  for (std::size_t i = 0; i < order_.size(); ++i) {
    order_[i] = static_cast<Eigen::Index>(i);
    ranked_[i] = std::isfinite(values[i]) ? values[i] : std::numeric_limits<double>::infinity();
  }
  std::ranges::sort(order_, [&](Eigen::Index a, Eigen::Index b) {
    const double value_a = ranked_[static_cast<std::size_t>(a)], value_b = ranked_[static_cast<std::size_t>(b)];
    return value_a < value_b || (value_a == value_b && a < b);
  });
  std::ranges::sort(ranked_);
  if (!std::isfinite(ranked_.front())) {
    throw OptimizeError("cma_es: the objective is not finite at any of the " + std::to_string(order_.size()) +
                        " candidates of generation " + std::to_string(state_.generation) +
                        "; start where it is defined, or with a smaller sigma");
  }
}

// The mean and both paths (equations 42, 43 and 45).
SUREFOOT_INLINE void CmaEsCore::move_mean() {
  const CmaEsConstants& c = constants_;
  mean_step_.setZero(state_.dimension());
  mean_normal_.setZero(state_.dimension());
  for (Eigen::Index i = 0; i < c.parents; ++i) {
    mean_step_ += c.weights[i] * step_.col(order_[static_cast<std::size_t>(i)]);
    mean_normal_ += c.weights[i] * normal_.col(order_[static_cast<std::size_t>(i)]);
  }
  state_.mean += state_.sigma * mean_step_;
  state_.path_sigma =
      (1 - c.c_sigma) * state_.path_sigma + std::sqrt(c.c_sigma * (2 - c.c_sigma) * c.mu_eff) * mean_normal_;

  const auto n = static_cast<double>(state_.dimension());
  const double forgotten = 1 - std::pow(1 - c.c_sigma, 2 * static_cast<double>(state_.generation + 1));
  stalled_ = state_.path_sigma.norm() / std::sqrt(forgotten) >= (1.4 + 2 / (n + 1)) * c.normal_norm;
  state_.path *= 1 - c.c_path;
  if (!stalled_) state_.path += std::sqrt(c.c_path * (2 - c.c_path) * c.mu_eff) * mean_step_;
}

// Equations 46 and 47.
SUREFOOT_INLINE void CmaEsCore::adapt_covariance() {
  const CmaEsConstants& c = constants_;
  const Eigen::Index n = state_.dimension();
  const double kept = 1 - c.c_one * (stalled_ ? 1 - c.c_path * (2 - c.c_path) : 1) - c.c_mu * c.weights.sum();
  scaled_weights_ = c.c_mu * c.weights;
  for (Eigen::Index i = c.parents; i < state_.population; ++i) {
    scaled_weights_[i] *= static_cast<double>(n) / normal_.col(order_[static_cast<std::size_t>(i)]).squaredNorm();
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    auto column = state_.covariance.col(j).tail(n - j);
    column = kept * column + (c.c_one * state_.path[j]) * state_.path.tail(n - j);
    for (Eigen::Index i = 0; i < state_.population; ++i) {
      const auto step = step_.col(order_[static_cast<std::size_t>(i)]);
      column += (scaled_weights_[i] * step[j]) * step.tail(n - j);
    }
  }
}

// Equation 44.
SUREFOOT_INLINE void CmaEsCore::adapt_sigma() {
  const CmaEsConstants& c = constants_;
  const double longer = state_.path_sigma.norm() / c.normal_norm - 1;
  state_.sigma *= std::exp(std::min(1.0, c.c_sigma / c.damping * longer));
}

SUREFOOT_INLINE void CmaEsCore::record_values() {
  state_.value_range = ranked_.back() - ranked_.front();
  state_.best_values.push_back(ranked_.front());
  state_.median_values.push_back(ranked_[ranked_.size() / 2]);
  if (state_.best_values.size() > state_.history()) {
    state_.best_values.pop_front();
    state_.median_values.pop_front();
  }
}

SUREFOOT_INLINE void CmaEsCore::factorise() {
  state_.factor = state_.covariance;
  state_.degenerate = !detail::factorise_in_place(state_.factor);
  for (Eigen::Index i = 0; i < state_.dimension(); ++i) {
    if (!std::isfinite(state_.factor(i, i))) state_.degenerate = true;
  }
}

}  // namespace surefoot
