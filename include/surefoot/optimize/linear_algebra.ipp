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

SUREFOOT_INLINE double condition_of_symmetric(const Eigen::MatrixXd& a) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (a.rows() == 1) return a(0, 0) > 0 ? 1 : infinity;
  // The steps of SelfAdjointEigenSolver::compute without those for eigenvectors, which cost seconds to compile.
  Eigen::MatrixXd scaled = a.triangularView<Eigen::Lower>();
  double scale = scaled.cwiseAbs().maxCoeff();
  if (scale == 0) scale = 1;
  scaled.triangularView<Eigen::Lower>() /= scale;
  const Eigen::Tridiagonalization<Eigen::MatrixXd> tridiagonal(scaled);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(tridiagonal.diagonal(), tridiagonal.subDiagonal(), Eigen::EigenvaluesOnly);
  const double smallest = scale * solver.eigenvalues().minCoeff();
  return smallest > 0 ? scale * solver.eigenvalues().maxCoeff() / smallest : infinity;
}

}  // namespace surefoot::detail
