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

SUREFOOT_INLINE Cholesky::Cholesky(const Eigen::MatrixXd& a) : lower_(a) { ok_ = factorise_in_place(lower_); }

SUREFOOT_INLINE void Cholesky::solve_in_place(Eigen::MatrixXd& b) const {
  lower_.triangularView<Eigen::Lower>().solveInPlace(b);
  lower_.triangularView<Eigen::Lower>().adjoint().solveInPlace(b);
}

SUREFOOT_INLINE Eigen::MatrixXd Cholesky::inverse() const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(lower_.rows(), lower_.cols());
  solve_in_place(result);
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd Cholesky::solve_lower(const Eigen::VectorXd& b) const {
  return lower_.triangularView<Eigen::Lower>().solve(b);
}

SUREFOOT_INLINE Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x = b;
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  lower_.triangularView<Eigen::Lower>().adjoint().solveInPlace(x);
  return x;
}

SUREFOOT_INLINE Eigen::VectorXd multiply(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) { return a * x; }

SUREFOOT_INLINE Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a * b; }

SUREFOOT_INLINE double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return a.dot(b); }

SUREFOOT_INLINE double squared_norm(const Eigen::VectorXd& a) { return a.squaredNorm(); }

}  // namespace surefoot::detail
