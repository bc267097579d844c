// Definitions of surefoot/optimize/householder.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/householder.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE void reflect(double* x, Eigen::Index count, double& factor) {
  const double rest = dot(x + 1, x + 1, count - 1);
  factor = 0;
  if (rest <= std::numeric_limits<double>::min()) {
    for (Eigen::Index i = 1; i < count; ++i) x[i] = 0;
    return;
  }
  const double first = x[0], length = std::sqrt(first * first + rest);
  x[0] = first >= 0 ? -length : length;
  for (Eigen::Index i = 1; i < count; ++i) x[i] /= first - x[0];
  factor = (x[0] - first) / x[0];
}

SUREFOOT_INLINE void apply_reflection(const double* rest, double factor, Eigen::MatrixXd& a, Eigen::Index row,
                                      Eigen::Index column) {
  const Eigen::Index count = a.rows() - row - 1;
  for (Eigen::Index j = column; j < a.cols(); ++j) {
    double* const x = &a(row, j);
    if (count == 0) {
      x[0] *= 1 - factor;
    } else if (factor != 0) {
      const bool alone = column + 1 == a.cols();
      const double along = (alone ? dot(rest, x + 1, count) : dot_by_two(rest, x + 1, count)) + x[0];
      x[0] -= factor * along;
      for (Eigen::Index i = 0; i < count; ++i) x[1 + i] -= factor * rest[i] * along;
    }
  }
}

/// Lengths of the columns of a matrix, below its first rows, from one elimination to the next.
struct ColumnLengths {
  Eigen::VectorXd updated, direct;  // as last computed from the one before, and from the column itself

  /// After the elimination of row k; anew from the column where the update would lose half of the digits.
  void remove_row(const Eigen::MatrixXd& a, Eigen::Index k, Eigen::Index j) {
    if (updated[j] == 0) return;
    const double ratio = std::abs(a(k, j)) / updated[j];
    const double left = std::max((1 + ratio) * (1 - ratio), 0.0);
    const double change = updated[j] / direct[j];
    if (left * (change * change) > std::sqrt(std::numeric_limits<double>::epsilon())) {
      updated[j] *= std::sqrt(left);
      return;
    }
    const double* const below = a.data() + j * a.rows() + k + 1;
    direct[j] = updated[j] = std::sqrt(dot(below, below, a.rows() - k - 1));
  }
};

SUREFOOT_INLINE Eigen::MatrixXd orthonormal_basis(Eigen::MatrixXd a) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const Eigen::Index rows = a.rows(), size = std::min(rows, a.cols());
  Eigen::VectorXd factors(size);
  ColumnLengths lengths{Eigen::VectorXd(a.cols()), {}};
  double longest = 0;
  for (Eigen::Index j = 0; j < a.cols(); ++j) longest = std::max(longest, lengths.updated[j] = column_norm(a, j));
  lengths.direct = lengths.updated;
  const double negligible = longest * epsilon * (longest * epsilon) / static_cast<double>(rows);  // square, per row
  Eigen::Index pivots = size;  // that are not negligible
  double largest = 0;
  for (Eigen::Index k = 0; k < size; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index j = k + 1; j < a.cols(); ++j) {
      if (lengths.updated[j] > lengths.updated[pivot]) pivot = j;
    }
    const double length = lengths.updated[pivot];
    if (pivots == size && length * length < negligible * static_cast<double>(rows - k)) pivots = k;
    if (pivot != k) {
      std::swap_ranges(&a(0, k), &a(0, k) + rows, &a(0, pivot));
      std::swap(lengths.updated[k], lengths.updated[pivot]);
      std::swap(lengths.direct[k], lengths.direct[pivot]);
    }
    reflect(&a(k, k), rows - k, factors[k]);
    largest = std::max(largest, std::abs(a(k, k)));
    apply_reflection(&a(k, k) + 1, factors[k], a, k, k + 1);
    for (Eigen::Index j = k + 1; j < a.cols(); ++j) lengths.remove_row(a, k, j);
  }
  Eigen::Index rank = 0;
  for (Eigen::Index k = 0; k < pivots; ++k) {
    if (std::abs(a(k, k)) > largest * (epsilon * static_cast<double>(size))) ++rank;
  }
  Eigen::MatrixXd basis = identity(rows, rank);
  for (Eigen::Index k = size; k-- > 0;) apply_reflection(&a(k, k) + 1, factors[k], basis, k, 0);
  return basis;
}

}  // namespace surefoot::detail
