// Least squares with an L1 penalty by cyclic coordinate descent (Friedman, Hastie & Tibshirani, "Regularization paths
// for generalized linear models via coordinate descent", 2010), with bounds.
#pragma once

#include <Eigen/Core>

namespace all_at_once {

/// Minimises |z' G z| / 2 - b' z + penalty * sum |z|. G has ones on its diagonal; a column to be left out has zeros
/// throughout.
struct Lasso {
  Eigen::MatrixXd gram;
  Eigen::VectorXd pull;       // b
  Eigen::VectorXd low, high;  // bounds of z, low <= 0 <= high
};

/// The least penalty at which nothing survives.
double largest_penalty(const Lasso& lasso);

/// From `start` on; cost of a sweep: the square of the number of unknowns at worst.
Eigen::VectorXd solve(const Lasso& lasso, double penalty, Eigen::VectorXd start);

}  // namespace all_at_once
