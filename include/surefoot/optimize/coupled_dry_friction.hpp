// Dry friction at coupled joints: which of them stick and which slip in a step of time.
//
// With the mass matrix A (symmetric, positive definite; whatever is implicit in the velocities is in it), the momentum
// b that the step would reach without friction, and the largest friction impulse f_i of each joint, the velocities v
// after the step solve the complementarity problem A v = b + p, |p_i| <= f_i, p_i = -f_i sign(v_i) where v_i != 0. They
// are the only minimum of v'Av / 2 - b'v + sum f_i |v_i| (Moreau; the same problem is known as the lasso), so that
// friction never adds energy and a joint that sticks has velocity 0, not nearly 0. Solved by sets of sticking joints,
// warm from the step before, with coordinate descent where these would cycle. Cost: n^3 / 3 for n joints, once where
// nothing changes.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot {

/// Memory of `solve_coupled_dry_friction`, so that a step allocates nothing.
struct CoupledDryFriction {
  Eigen::VectorXi sign;  // by joint: -1, 1 slips that way, 0 sticks; kept from step to step
  Eigen::MatrixXd factor;
  Eigen::VectorXd reduced;
  Eigen::VectorXi slipping;
};

/// Writes the velocities after the step into `v`. `friction` is not negative; a joint where it is 0 moves freely.
void solve_coupled_dry_friction(const Eigen::MatrixXd& mass, const Eigen::VectorXd& momentum,
                                const Eigen::VectorXd& friction, CoupledDryFriction& work, Eigen::VectorXd& v);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/coupled_dry_friction.ipp"
#endif
