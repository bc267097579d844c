// Definitions of surefoot/optimize/linear_algebra.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <limits>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.ldlt().solve(b);
}

SUREFOOT_INLINE Eigen::MatrixXd invert_symmetric(const Eigen::MatrixXd& a) {
  return a.ldlt().solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

SUREFOOT_INLINE bool factorise_in_place(Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(a);
  return in_place.info() == Eigen::Success;
}

SUREFOOT_INLINE SymmetricEigen eigen_of_symmetric(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SUREFOOT_INLINE double condition_of_symmetric(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, Eigen::EigenvaluesOnly);
  const double smallest = solver.eigenvalues().minCoeff();
  return smallest > 0 ? solver.eigenvalues().maxCoeff() / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace surefoot::detail
