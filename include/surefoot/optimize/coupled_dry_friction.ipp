// Definitions of coupled_dry_friction.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/optimize/coupled_dry_friction.hpp"

namespace surefoot {

namespace detail {

inline constexpr int friction_set_changes = 12;  // sets tried before coordinate descent: warm, one or two are enough
inline constexpr int friction_sweeps = 2000;     // of coordinate descent at most; each lowers the energy
inline constexpr double friction_tolerance = 1e-13;  // of a velocity, relative to the largest

// Velocities of the slipping joints from A_ss v_s = b_s - f_s sign_s by Cholesky, those of the others 0.
inline void velocities_of_set(const Eigen::MatrixXd& mass, const Eigen::VectorXd& momentum,
                              const Eigen::VectorXd& friction, CoupledDryFriction& work, Eigen::VectorXd& v) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < momentum.size(); ++i) {
    if (work.sign[i] != 0) work.slipping[count++] = static_cast<int>(i);
  }
  Eigen::MatrixXd& l = work.factor;
  for (Eigen::Index c = 0; c < count; ++c) {
    const Eigen::Index i = work.slipping[c];
    double right = momentum[i] - friction[i] * work.sign[i];
    double diagonal = mass(i, i);
    for (Eigen::Index k = 0; k < c; ++k) {
      double sum = mass(i, work.slipping[k]);
      for (Eigen::Index m = 0; m < k; ++m) sum -= l(c, m) * l(k, m);
      l(c, k) = sum / l(k, k);
      diagonal -= l(c, k) * l(c, k);
      right -= l(c, k) * work.reduced[k];
    }
    l(c, c) = std::sqrt(diagonal);
    work.reduced[c] = right / l(c, c);
  }
  v.setZero();
  for (Eigen::Index c = count; c-- > 0;) {
    double value = work.reduced[c];
    for (Eigen::Index k = c + 1; k < count; ++k) value -= l(k, c) * v[work.slipping[k]];
    v[work.slipping[c]] = value / l(c, c);
  }
}

// Element i of A v.
inline double momentum_of(const Eigen::MatrixXd& mass, Eigen::Index i, const Eigen::VectorXd& v) {
  double sum = mass(i, 0) * v[0];
  for (Eigen::Index k = 1; k < v.size(); ++k) sum += mass(i, k) * v[k];
  return sum;
}

// Sticks what turned back, frees what is pushed beyond its friction. False if nothing had to change.
inline bool change_set(const Eigen::MatrixXd& mass, const Eigen::VectorXd& momentum, const Eigen::VectorXd& friction,
                       CoupledDryFriction& work, const Eigen::VectorXd& v) {
  bool changed = false;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (friction[i] == 0) continue;
    if (work.sign[i] != 0) {
      if (v[i] * work.sign[i] > 0) continue;
      work.sign[i] = 0;
    } else {
      const double push = momentum[i] - momentum_of(mass, i, v);
      if (std::abs(push) <= friction[i] * (1 + friction_tolerance)) continue;
      work.sign[i] = push > 0 ? 1 : -1;
    }
    changed = true;
  }
  return changed;
}

inline void coordinate_descent(const Eigen::MatrixXd& mass, const Eigen::VectorXd& momentum,
                               const Eigen::VectorXd& friction, Eigen::VectorXd& v) {
  for (int sweep = 0; sweep < friction_sweeps; ++sweep) {
    double moved = 0, largest = 0;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const double push = momentum[i] - momentum_of(mass, i, v) + mass(i, i) * v[i];
      const double next = std::copysign(std::max(0.0, std::abs(push) - friction[i]), push) / mass(i, i);
      moved = std::max(moved, std::abs(next - v[i]));
      v[i] = next;
    }
    for (Eigen::Index i = 0; i < v.size(); ++i) largest = std::max(largest, std::abs(v[i]));
    if (moved <= friction_tolerance * largest) return;
  }
}

}  // namespace detail

SUREFOOT_INLINE void solve_coupled_dry_friction(const Eigen::MatrixXd& mass, const Eigen::VectorXd& momentum,
                                                const Eigen::VectorXd& friction, CoupledDryFriction& work,
                                                Eigen::VectorXd& v) {
  const Eigen::Index n = momentum.size();
  if (work.sign.size() != n) {
    work.sign = Eigen::VectorXi::Zero(n);
    work.factor.resize(n, n);
    work.reduced.resize(n);
    work.slipping.resize(n);
  }
  v.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (friction[i] == 0) work.sign[i] = 1;  // free: part of every set
  }
  for (int change = 0; change < detail::friction_set_changes; ++change) {
    detail::velocities_of_set(mass, momentum, friction, work, v);
    if (!detail::change_set(mass, momentum, friction, work, v)) return;
  }
  detail::coordinate_descent(mass, momentum, friction, v);
  for (Eigen::Index i = 0; i < n; ++i) work.sign[i] = friction[i] == 0 ? 1 : (v[i] > 0) - (v[i] < 0);
}

}  // namespace surefoot
