// Definitions of surefoot/optimize/cma_es_constants.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/cma_es_constants.hpp"

namespace surefoot {

SUREFOOT_ONCE CmaEsConstants cma_es_constants(Eigen::Index dimension, Eigen::Index population) {
  const auto n = static_cast<double>(dimension);
  CmaEsConstants c;
  c.parents = population / 2;
  c.weights.resize(population);
  for (Eigen::Index i = 0; i < population; ++i) {
    c.weights[i] = std::log((static_cast<double>(population) + 1) / 2) - std::log(static_cast<double>(i) + 1);
  }
  auto positive = c.weights.head(c.parents);
  auto negative = c.weights.tail(population - c.parents);
  c.mu_eff = positive.sum() * positive.sum() / positive.squaredNorm();
  const double mu_eff_minus = negative.sum() * negative.sum() / negative.squaredNorm();

  c.c_sigma = (c.mu_eff + 2) / (n + c.mu_eff + 5);
  c.damping = 1 + 2 * std::max(0.0, std::sqrt((c.mu_eff - 1) / (n + 1)) - 1) + c.c_sigma;
  c.c_path = (4 + c.mu_eff / n) / (n + 4 + 2 * c.mu_eff / n);
  c.c_one = 2 / ((n + 1.3) * (n + 1.3) + c.mu_eff);
  c.c_mu = std::min(1 - c.c_one, 2 * (0.25 + c.mu_eff + 1 / c.mu_eff - 2) / ((n + 2) * (n + 2) + c.mu_eff));
  c.normal_norm = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));

  // The negative weights sum to minus the smaller of what the number of bad candidates carries and what surely keeps
  // the covariance positive definite (equations 51 and 52). The tutorial has a third bound, 1 + c_one / c_mu, only so
  // that all weights cancel. Without it ill-conditioned problems in 12 to 40 dimensions take 10 to 20 % fewer
  // evaluations; nothing that was tried takes more.
  const double carried = 1 + 2 * mu_eff_minus / (c.mu_eff + 2);
  const double definite = (1 - c.c_one - c.c_mu) / (n * c.c_mu);
  positive /= positive.sum();
  negative *= -std::min(carried, definite) / negative.sum();

  // As often as the covariance has changed by about as much as one dimension's worth.
  c.factor_gap = std::max(1L, static_cast<long>(0.5 / (n * (c.c_one + c.c_mu))));
  return c;
}

}  // namespace surefoot
