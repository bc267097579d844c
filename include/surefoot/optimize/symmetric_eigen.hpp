// Eigenvalues and eigenvectors of small symmetric matrices, compiled once. Cost: of the order of n^3.
//
// Householder's tridiagonal form and then QR steps with Wilkinson's shift (Golub, Van Loan: "Matrix Computations",
// algorithms 8.3.1 to 8.3.3), all sums in the order of Eigen 3.4's SelfAdjointEigenSolver: the results are equal to the
// last bit, for a tenth of what that costs the compiler.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

struct SymmetricEigen {
  Eigen::VectorXd values;   // rising
  Eigen::MatrixXd vectors;  // by column, in the same order
};

/// Of the lower triangle of `a`.
SymmetricEigen eigen_of_symmetric(const Eigen::MatrixXd& a);

/// Largest over smallest eigenvalue; infinite unless all are positive.
double condition_of_symmetric(const Eigen::MatrixXd& a);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/symmetric_eigen.ipp"
#endif
