// Definitions of surefoot/optimize/symmetric_eigen.hpp.
#pragma once

#include <Eigen/Eigenvalues>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE SymmetricEigen eigen_of_symmetric(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace surefoot::detail
