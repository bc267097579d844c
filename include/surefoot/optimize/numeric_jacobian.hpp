// The derivative of a vector function by central differences. Error about 1e-10 of the function's own curvature scale;
// cost 2 n evaluations in n dimensions.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "surefoot/core/box.hpp"

namespace surefoot {

/// One row per value, one column per variable. With a box no point outside it is evaluated: at a face the difference
/// becomes one-sided. Steps are 6e-6 (the cube root of the precision of double) of the larger of |x| and the box's
/// width; without a box, of the larger of |x| and 1.
template <class F>
Eigen::MatrixXd numeric_jacobian(const F& function, const Eigen::VectorXd& x,
                                 const std::optional<Box<Eigen::Dynamic>>& box = std::nullopt) {
  constexpr double relative_step = 6e-6;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd point = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double scale = box ? box->high()[i] - box->low()[i] : 1.0;
    const double step = relative_step * std::max(std::abs(x[i]), scale);
    double above = x[i] + step, below = x[i] - step;
    if (box) {
      above = std::min(above, box->high()[i]);
      below = std::max(below, box->low()[i]);
    }
    point[i] = above;
    const Eigen::VectorXd value_above = function(point);
    point[i] = below;
    const Eigen::VectorXd value_below = function(point);
    point[i] = x[i];
    if (i == 0) jacobian.resize(value_above.size(), x.size());
    if (above > below) {
      for (Eigen::Index k = 0; k < jacobian.rows(); ++k) {
        jacobian(k, i) = (value_above[k] - value_below[k]) / (above - below);
      }
    } else {  // a box without width in this dimension
      for (Eigen::Index k = 0; k < jacobian.rows(); ++k) jacobian(k, i) = 0;
    }
  }
  return jacobian;
}

}  // namespace surefoot
