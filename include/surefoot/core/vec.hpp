// Fixed-size column vectors of double: the states, actions and points of everything else.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace surefoot {

/// Column vector of N doubles; N may be Eigen::Dynamic.
template <int N>
using Vec = Eigen::Matrix<double, N, 1>;

/// Whether every element of a vector or matrix is finite; as its allFinite(), without a type per expression.
template <class VectorOrMatrix>
bool all_finite(const VectorOrMatrix& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values.data()[i])) return false;
  }
  return true;
}

/// The square roots of the diagonal of a square matrix.
template <int N>
Vec<N> roots_of_diagonal(const Eigen::Matrix<double, N, N>& a) {
  Vec<N> roots(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) roots[i] = std::sqrt(a(i, i));
  return roots;
}

}  // namespace surefoot
