// Decompositions of small symmetric matrices, compiled once: what least squares, CMA-ES and the fits of motion models
// share. Cost of each: of the order of n^3.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

/// Solutions of a x = b for symmetric `a` (L D L^T with pivots): one per column of b.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd invert_symmetric(const Eigen::MatrixXd& a);

/// Replaces the lower triangle of `a` by its Cholesky factor; false if `a` is not positive definite.
bool factorise_in_place(Eigen::MatrixXd& a);

/// Largest over smallest eigenvalue; infinite unless all are positive.
double condition_of_symmetric(const Eigen::MatrixXd& a);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/linear_algebra.ipp"
#endif
