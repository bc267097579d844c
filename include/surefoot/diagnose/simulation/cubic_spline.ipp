// Definitions of surefoot/diagnose/simulation/cubic_spline.hpp.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/simulation/cubic_spline.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<double> second_derivatives(const Eigen::VectorXd& times, const Eigen::VectorXd& values) {
  const auto rows = static_cast<std::size_t>(values.size());
  if (rows < 3) return {};
  std::vector<double> bends(rows, 0.0), share(rows, 0.0);
  const auto slope = [&](Eigen::Index row) { return (values[row + 1] - values[row]) / (times[row + 1] - times[row]); };
  for (std::size_t i = 1; i + 1 < rows; ++i) {  // a tridiagonal system: forwards and back
    const auto row = static_cast<Eigen::Index>(i);
    const double before = times[row] - times[row - 1], after = times[row + 1] - times[row];
    const double pivot = 2 * (before + after) - before * share[i - 1];
    share[i] = after / pivot;
    bends[i] = (6 * (slope(row) - slope(row - 1)) - before * bends[i - 1]) / pivot;
  }
  for (std::size_t i = rows - 2; i > 0; --i) bends[i] -= share[i] * bends[i + 1];
  return bends;
}

}  // namespace surefoot::diagnosis
