#include "surefoot/optimize/coupled_dry_friction.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/rng.hpp"

using surefoot::CoupledDryFriction;
using surefoot::solve_coupled_dry_friction;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, surefoot::Rng& rng) {
  Eigen::MatrixXd result(rows, columns);
  for (double& value : result.reshaped()) value = 2 * rng.uniform() - 1;
  return result;
}

}  // namespace

TEST_CASE("velocities after a step with coupled dry friction solve the complementarity problem") {
  surefoot::Rng rng(1);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Index n = 1 + trial % 12;
    const Eigen::MatrixXd root = random_matrix(n, n, rng);
    const Eigen::MatrixXd mass = root * root.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd momentum = random_matrix(n, 1, rng);
    Eigen::VectorXd friction = random_matrix(n, 1, rng).cwiseMax(0.0), v(n);
    CoupledDryFriction work;
    solve_coupled_dry_friction(mass, momentum, friction, work, v);
    const Eigen::VectorXd impulse = mass * v - momentum;
    for (Eigen::Index i = 0; i < n; ++i) {
      CHECK(std::abs(impulse[i]) <= friction[i] + 1e-9);
      if (v[i] != 0) CHECK(impulse[i] == doctest::Approx(-friction[i] * (v[i] > 0 ? 1 : -1)).epsilon(1e-7));
    }
  }
}

TEST_CASE("a joint that friction can hold stands still exactly, whatever pushes its neighbour") {
  const Eigen::MatrixXd mass{{2.0, 0.7}, {0.7, 1.0}};
  const Eigen::VectorXd momentum{{3.0, 0.5}}, friction{{0.1, 2.0}};
  CoupledDryFriction work;
  Eigen::VectorXd v;
  solve_coupled_dry_friction(mass, momentum, friction, work, v);
  CHECK(v[1] == 0.0);
  CHECK(v[0] == doctest::Approx(2.9 / 2));
}

TEST_CASE("coupled dry friction never adds energy") {
  surefoot::Rng rng(2);
  CoupledDryFriction work;
  const Eigen::MatrixXd root = random_matrix(4, 4, rng);
  const Eigen::MatrixXd mass = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(4, 4);
  const Eigen::VectorXd friction = Eigen::VectorXd::Constant(4, 0.01);
  Eigen::VectorXd v = random_matrix(4, 1, rng), next(4);
  double energy = v.dot(mass * v);
  for (int step = 0; step < 1000; ++step) {
    solve_coupled_dry_friction(mass, mass * v, friction, work, next);
    v = next;
    const double now = v.dot(mass * v);
    CHECK(now <= energy * (1 + 1e-12));
    energy = now;
  }
  CHECK(v.isZero(0));  // all of it is gone
}
