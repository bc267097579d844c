// Joints whose columns were swapped: what one is told moves the other.
#pragma once

#include <utility>
#include <vector>

#include "linearize.hpp"

namespace diagnose_robot {

/// Fraction of the variance of each goal (row) that the motion of each joint (column) leaves unexplained.
Eigen::MatrixXd unexplained_commands(const Evidence& evidence);

struct SwapCriteria {
  /// Of the variance left by the columns as they are: where swapping leaves less than a quarter, errors are halved.
  double share = 0.25;
  double explained = 0.3;  // of the variance that swapped columns may leave: more is no sign that they belong together
};

/// Pairs of joints that belong to each other's columns, from such fractions alone.
std::vector<std::pair<int, int>> swapped_pairs(const Eigen::MatrixXd& unexplained, const SwapCriteria& criteria = {});

}  // namespace diagnose_robot
