// Linear-quadratic control of a problem's own dynamics around the origin.
#pragma once

#include <Eigen/Dense>

#include "reference.hpp"
#include "surefoot/core/box.hpp"

namespace classic {

/// The return of linear feedback with the gain of the discrete algebraic Riccati equation, for costs
/// x' Q x + action_cost u' u. Exact where the problem is linear.
template <surefoot::Problem P>
Reference linear_reference(const P& problem, const Eigen::Matrix<double, P::state_dim, P::state_dim>& q,
                           double action_cost, const char* how) {
  constexpr int n = P::state_dim, m = P::action_dim;
  constexpr double h = 1e-5;
  Eigen::Matrix<double, n, n> a;
  Eigen::Matrix<double, n, m> b;
  surefoot::Rng none(0);
  const auto next = [&](const surefoot::Vec<n>& x, const surefoot::Vec<m>& u) { return problem.step(x, u, none).next; };
  for (int i = 0; i < n; ++i) {
    const surefoot::Vec<n> e = h * surefoot::Vec<n>::Unit(i);
    a.col(i) = (next(e, surefoot::Vec<m>::Zero()) - next(-e, surefoot::Vec<m>::Zero())) / (2 * h);
  }
  for (int i = 0; i < m; ++i) {
    const surefoot::Vec<m> e = h * surefoot::Vec<m>::Unit(i);
    b.col(i) = (next(surefoot::Vec<n>::Zero(), e) - next(surefoot::Vec<n>::Zero(), -e)) / (2 * h);
  }
  const Eigen::Matrix<double, m, m> r = action_cost * Eigen::Matrix<double, m, m>::Identity();
  Eigen::Matrix<double, n, n> cost = q;
  Eigen::Matrix<double, m, n> gain;
  for (int i = 0; i < 20'000; ++i) {
    gain = (r + b.transpose() * cost * b).ldlt().solve(b.transpose() * cost * a);
    const Eigen::Matrix<double, n, n> before = cost;
    cost = q + a.transpose() * cost * (a - b * gain);
    cost = (0.5 * (cost + cost.transpose())).eval();
    if ((cost - before).norm() < 1e-12 * cost.norm()) break;
  }
  const surefoot::Box<m> box = problem.action_box();
  return {evaluated(problem, [&](const typename P::State& x) { return typename P::Action(box.clamp(-gain * x)); }),
          how};
}

}  // namespace classic
