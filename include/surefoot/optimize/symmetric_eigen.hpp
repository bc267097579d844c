// Eigenvalues and eigenvectors of small symmetric matrices, compiled once. Cost: of the order of n^3.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

struct SymmetricEigen {
  Eigen::VectorXd values;   // rising
  Eigen::MatrixXd vectors;  // by column, in the same order
};
SymmetricEigen eigen_of_symmetric(const Eigen::MatrixXd& a);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/symmetric_eigen.ipp"
#endif
