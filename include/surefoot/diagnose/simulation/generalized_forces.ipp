// Definitions of surefoot/diagnose/simulation/generalized_forces.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/simulation/generalized_forces.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Eigen::VectorXd solved(Eigen::MatrixXd a, Eigen::VectorXd b) {
  const Eigen::Index n = b.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    for (Eigen::Index j = 0; j < n && pivot != k; ++j) std::swap(a(k, j), a(pivot, j));
    std::swap(b[k], b[pivot]);
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double factor = a(i, k) / a(k, k);
      for (Eigen::Index j = k; j < n; ++j) a(i, j) -= factor * a(k, j);
      b[i] -= factor * b[k];
    }
  }
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    for (Eigen::Index j = k + 1; j < n; ++j) b[k] -= a(k, j) * b[j];
    b[k] /= a(k, k);
  }
  return b;
}

SUREFOOT_INLINE Eigen::VectorXd holding_forces(const Eigen::MatrixXd& responses, const Eigen::VectorXd& rates,
                                               const Eigen::VectorXd& limits) {
  constexpr int most_sweeps = 200;
  constexpr double settled = 1e-12;  // change of a force in a sweep, as a share of its limit
  const Eigen::Index n = rates.size();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(n);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool moved = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      double rate = rates[i];
      for (Eigen::Index j = 0; j < n; ++j) rate += responses(i, j) * forces[j];
      const double wanted = std::clamp(forces[i] - rate / responses(i, i), -limits[i], limits[i]);
      moved = moved || std::abs(wanted - forces[i]) > settled * limits[i];
      forces[i] = wanted;
    }
    if (!moved) break;
  }
  return forces;
}

}  // namespace surefoot::diagnosis
