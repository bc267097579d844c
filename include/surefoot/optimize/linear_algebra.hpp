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

struct SymmetricEigen {
  Eigen::VectorXd values;   // rising
  Eigen::MatrixXd vectors;  // by column, in the same order
};
SymmetricEigen eigen_of_symmetric(const Eigen::MatrixXd& a);

/// Largest over smallest eigenvalue; infinite unless all are positive.
double condition_of_symmetric(const Eigen::MatrixXd& a);

/// a = L L^T.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& a);

  bool ok() const { return ok_; }                          // whether `a` is positive definite
  const Eigen::MatrixXd& lower() const { return lower_; }  // L; what stands above its diagonal means nothing
  double half_log_determinant() const { return lower_.diagonal().array().log().sum(); }

  /// Solutions of a x = b, and of L x = b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::VectorXd solve_lower(const Eigen::VectorXd& b) const;
  void solve_in_place(Eigen::MatrixXd& b) const;
  Eigen::MatrixXd inverse() const;

 private:
  Eigen::MatrixXd lower_;
  bool ok_ = false;
};

/// Products and sums of squares.
Eigen::VectorXd multiply(const Eigen::MatrixXd& a, const Eigen::VectorXd& x);
Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b);
double squared_norm(const Eigen::VectorXd& a);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/linear_algebra.ipp"
#endif
