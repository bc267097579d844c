// Cholesky decomposition and products of information matrices, as small as a motion model has parameters.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

/// a = L L^T.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& a);

  bool ok() const { return ok_; }                          // whether `a` is positive definite
  const Eigen::MatrixXd& lower() const { return lower_; }  // L; what stands above its diagonal means nothing
  double half_log_determinant() const;

  /// Solutions of a x = b, and of L x = b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::VectorXd solve_lower(const Eigen::VectorXd& b) const;
  void solve_in_place(Eigen::MatrixXd& b) const;
  Eigen::MatrixXd inverse() const;

 private:
  Eigen::MatrixXd lower_;
  bool ok_ = false;
};

/// Products of square matrices and vectors of one size.
Eigen::VectorXd multiply(const Eigen::MatrixXd& a, const Eigen::VectorXd& x);
Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b);
double squared_norm(const Eigen::VectorXd& a);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/monitor/cholesky.ipp"
#endif
