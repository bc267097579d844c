// Householder's reflections of small matrices, compiled once, and the orthonormal basis that they make of columns.
//
// QR with column pivots (Golub, Van Loan: "Matrix Computations", algorithm 5.4.1; norms of the remaining columns as in
// LAPACK working note 176), all sums in the order of Eigen 3.4's ColPivHouseholderQR: the results are equal to the last
// bit for fewer than 48 columns, beyond which Eigen applies reflections by blocks; Eigen's own costs the compiler
// seconds. Cost: m n^2 for m rows and n columns.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

/// Replaces x[1] to x[count - 1] by the rest of a vector v with v[0] = 1 for which (1 - factor v v^T) x = (x[0], 0,
/// ...) with the new x[0].
void reflect(double* x, Eigen::Index count, double& factor);

/// Multiplies rows row, row + 1, ... of the columns from `column` on by 1 - factor v v^T, v = (1, rest).
void apply_reflection(const double* rest, double factor, Eigen::MatrixXd& a, Eigen::Index row, Eigen::Index column);

/// An orthonormal basis of what the columns of `a` span; as many columns as `a` has rank.
Eigen::MatrixXd orthonormal_basis(Eigen::MatrixXd a);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/householder.ipp"
#endif
