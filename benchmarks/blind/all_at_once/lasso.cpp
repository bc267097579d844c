#include "lasso.hpp"

#include <algorithm>
#include <cmath>

namespace all_at_once {

double largest_penalty(const Lasso& lasso) {
  double largest = 0;
  for (Eigen::Index j = 0; j < lasso.pull.size(); ++j) {
    const double pull = lasso.pull[j];
    if (pull > 0 ? lasso.high[j] > 0 : lasso.low[j] < 0) largest = std::max(largest, std::abs(pull));
  }
  return largest;
}

Eigen::VectorXd solve(const Lasso& lasso, double penalty, Eigen::VectorXd z) {
  Eigen::VectorXd left = lasso.pull - lasso.gram * z;  // pull that is left at z
  const double enough = 1e-7 * std::max(lasso.pull.cwiseAbs().maxCoeff(), 1e-300);
  constexpr int most_sweeps = 2000;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest = 0;
    for (Eigen::Index j = 0; j < z.size(); ++j) {
      if (lasso.gram(j, j) == 0) continue;
      const double alone = left[j] + z[j];
      const double shrunk = std::copysign(std::max(0.0, std::abs(alone) - penalty), alone);
      const double moved = std::clamp(shrunk, lasso.low[j], lasso.high[j]) - z[j];
      if (moved == 0) continue;
      z[j] += moved;
      left -= moved * lasso.gram.col(j);
      largest = std::max(largest, std::abs(moved));
    }
    if (largest < enough) break;
  }
  return z;
}

}  // namespace all_at_once
