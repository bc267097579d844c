// Definitions of surefoot/optimize/linear_algebra.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE double dot(const double* a, const double* b, Eigen::Index count) {
  if (count == 0) return 0;
  if (count == 1) return a[0] * b[0];
  double s0 = a[0] * b[0], s1 = a[1] * b[1];
  if (count >= 4) {
    double s2 = a[2] * b[2], s3 = a[3] * b[3];
    Eigen::Index i = 4;
    for (; i + 4 <= count; i += 4) {
      s0 += a[i] * b[i];
      s1 += a[i + 1] * b[i + 1];
      s2 += a[i + 2] * b[i + 2];
      s3 += a[i + 3] * b[i + 3];
    }
    s0 += s2;
    s1 += s3;
    if (i + 2 <= count) {
      s0 += a[i] * b[i];
      s1 += a[i + 1] * b[i + 1];
    }
  }
  return count % 2 == 0 ? s0 + s1 : s0 + s1 + a[count - 1] * b[count - 1];
}

SUREFOOT_INLINE double dot_by_two(const double* a, const double* b, Eigen::Index count) {
  double s0 = 0, s1 = 0;
  for (Eigen::Index i = 0; i + 2 <= count; i += 2) {
    s0 += a[i] * b[i];
    s1 += a[i + 1] * b[i + 1];
  }
  return count % 2 == 0 ? s0 + s1 : s0 + s1 + a[count - 1] * b[count - 1];
}

SUREFOOT_INLINE Eigen::VectorXd row_of(const Eigen::MatrixXd& a, Eigen::Index row) {
  Eigen::VectorXd result(a.cols());
  for (Eigen::Index j = 0; j < a.cols(); ++j) result[j] = a(row, j);
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd column_of(const Eigen::MatrixXd& a, Eigen::Index column) {
  Eigen::VectorXd result(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) result[i] = a(i, column);
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd times(double factor, Eigen::VectorXd a) {
  for (double& value : a) value *= factor;
  return a;
}

SUREFOOT_INLINE double norm(const Eigen::VectorXd& a) { return std::sqrt(sum_of_squares(a)); }

SUREFOOT_INLINE double sum_of_squares(const Eigen::VectorXd& a) { return dot(a.data(), a.data(), a.size()); }

SUREFOOT_INLINE double column_norm(const Eigen::MatrixXd& a, Eigen::Index column) {
  const double* const first = a.data() + column * a.rows();
  return std::sqrt(dot(first, first, a.rows()));
}

SUREFOOT_INLINE Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.rows(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      for (Eigen::Index i = 0; i < a.rows(); ++i) result(i, j) += a(i, k) * b(k, j);
    }
  }
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd product(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(a.rows());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) result[i] += a(i, j) * x[j];
  }
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd add_lower_product(Eigen::VectorXd a, const Eigen::MatrixXd& lower,
                                                  const Eigen::VectorXd& x) {
  constexpr Eigen::Index panel = 8;  // columns whose products with the rows below them are summed first
  const Eigen::Index n = x.size();
  for (Eigen::Index begin = 0; begin < n; begin += panel) {
    const Eigen::Index end = std::min(n, begin + panel);
    for (Eigen::Index j = begin; j < end; ++j) {
      for (Eigen::Index i = j; i < end; ++i) a[i] += x[j] * lower(i, j);
    }
    for (Eigen::Index i = end; i < n; ++i) {
      double sum = 0;
      for (Eigen::Index j = begin; j < end; ++j) sum += lower(i, j) * x[j];
      a[i] += sum;
    }
  }
  return a;
}

SUREFOOT_INLINE Eigen::MatrixXd transposed(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd result(a.cols(), a.rows());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) result(j, i) = a(i, j);
  }
  return result;
}

SUREFOOT_INLINE Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd result(a.cols(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.cols(); ++i) {
      result(i, j) = dot(a.data() + i * a.rows(), b.data() + j * b.rows(), a.rows());
    }
  }
  return result;
}

/// The rows of a column from its first that is not 0 to its last, begun at a multiple of dot()'s four.
struct RowRange {
  Eigen::Index begin, end;
};

SUREFOOT_INLINE RowRange rows_in_use(const double* column, Eigen::Index count) {
  RowRange rows{0, count};
  while (rows.end > 0 && column[rows.end - 1] == 0) --rows.end;
  while (rows.begin < rows.end && column[rows.begin] == 0) ++rows.begin;
  rows.begin -= rows.begin % 4;
  return rows;
}

SUREFOOT_INLINE Eigen::MatrixXd weighted_square(const Eigen::MatrixXd& a, const Eigen::VectorXd& weights) {
  std::vector<RowRange> used;
  for (Eigen::Index j = 0; j < a.cols(); ++j) used.push_back(rows_in_use(a.data() + j * a.rows(), a.rows()));
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.cols(), a.cols());
  Eigen::VectorXd weighted(a.rows());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const RowRange own = used[static_cast<std::size_t>(j)];
    for (Eigen::Index k = own.begin; k < own.end; ++k) weighted[k] = weights[k] * a(k, j);
    for (Eigen::Index i = j; i < a.cols(); ++i) {
      const RowRange other = used[static_cast<std::size_t>(i)];
      const Eigen::Index begin = std::max(own.begin, other.begin), end = std::min(own.end, other.end);
      if (begin >= end) continue;
      result(i, j) = result(j, i) = dot(weighted.data() + begin, a.data() + i * a.rows() + begin, end - begin);
    }
  }
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd transposed_product(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  Eigen::VectorXd result(a.cols());
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const double* const column = a.data() + i * a.rows();
    result[i] = a.cols() == 1 ? dot(column, x.data(), a.rows()) : dot_by_two(column, x.data(), a.rows());
  }
  return result;
}

SUREFOOT_INLINE Eigen::MatrixXd scaled(const Eigen::VectorXd& diagonal, const Eigen::MatrixXd& a) {
  Eigen::MatrixXd result(a.rows(), a.cols());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) result(i, j) = diagonal[i] * a(i, j) * diagonal[j];
  }
  return result;
}

// One vector: panels of 8 unknowns. Within one L column by column, below it sums over the panel.
SUREFOOT_INLINE void solve_lower(const Eigen::MatrixXd& lower, Eigen::VectorXd& x, DiagonalOf diagonal) {
  constexpr Eigen::Index panel = 8;
  const Eigen::Index n = x.size();
  for (Eigen::Index begin = 0; begin < n; begin += panel) {
    const Eigen::Index end = std::min(n, begin + panel);
    for (Eigen::Index i = begin; i < end; ++i) {
      if (x[i] == 0) continue;
      if (diagonal == DiagonalOf::any) x[i] /= lower(i, i);
      for (Eigen::Index k = i + 1; k < end; ++k) x[k] -= x[i] * lower(k, i);
    }
    for (Eigen::Index i = end; i < n; ++i) {
      double sum = 0;
      for (Eigen::Index k = begin; k < end; ++k) sum += lower(i, k) * x[k];
      x[i] -= sum;
    }
  }
}

SUREFOOT_INLINE void solve_lower_transposed(const Eigen::MatrixXd& lower, Eigen::VectorXd& x, DiagonalOf diagonal) {
  constexpr Eigen::Index panel = 8;
  const Eigen::Index n = x.size();
  for (Eigen::Index end = n; end > 0; end -= std::min(end, panel)) {
    const Eigen::Index begin = end - std::min(end, panel);
    for (Eigen::Index i = end; i-- > begin && end < n;) x[i] -= dot_by_two(&lower(end, i), &x[end], n - end);
    for (Eigen::Index i = end; i-- > begin;) {
      if (i + 1 < end) x[i] -= dot(&lower(i + 1, i), &x[i + 1], end - i - 1);
      if (diagonal == DiagonalOf::any && x[i] != 0) x[i] /= lower(i, i);
    }
  }
}

// Many vectors: panels of 4 unknowns, and products with the inverse of the diagonal. Sums begin at 0.0, which decides
// the sign of those that are 0.

/// One over the diagonal of `lower`, or ones.
SUREFOOT_INLINE Eigen::VectorXd inverse_diagonal(const Eigen::MatrixXd& lower, DiagonalOf diagonal) {
  Eigen::VectorXd result = Eigen::VectorXd::Ones(lower.rows());
  for (Eigen::Index i = 0; i < lower.rows() && diagonal == DiagonalOf::any; ++i) result[i] = 1 / lower(i, i);
  return result;
}

SUREFOOT_INLINE void solve_lower(const Eigen::MatrixXd& lower, Eigen::MatrixXd& x, DiagonalOf diagonal) {
  constexpr Eigen::Index panel = 4;
  const Eigen::Index n = x.rows();
  const Eigen::VectorXd inverse = inverse_diagonal(lower, diagonal);
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    double* const y = x.data() + column * n;
    for (Eigen::Index begin = 0; begin < n; begin += panel) {
      const Eigen::Index end = std::min(n, begin + panel);
      for (Eigen::Index i = begin; i < end; ++i) {
        y[i] *= inverse[i];
        for (Eigen::Index k = i + 1; k < end; ++k) y[k] -= y[i] * lower(k, i);
      }
      const double* const l = lower.data() + begin * n;
      const double* const z = y + begin;
      for (Eigen::Index i = end; i < n; ++i) {
        y[i] -= 0.0 + l[i] * z[0] + l[n + i] * z[1] + l[2 * n + i] * z[2] + l[3 * n + i] * z[3];
      }
    }
  }
}

SUREFOOT_INLINE void solve_lower_transposed(const Eigen::MatrixXd& lower, Eigen::MatrixXd& x, DiagonalOf diagonal) {
  constexpr Eigen::Index panel = 4;
  const Eigen::Index n = x.rows();
  const Eigen::VectorXd inverse = inverse_diagonal(lower, diagonal);
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    double* const y = x.data() + column * n;
    for (Eigen::Index end = n; end > 0; end -= std::min(end, panel)) {
      const Eigen::Index begin = end - std::min(end, panel);
      for (Eigen::Index i = end; i-- > begin;) {
        double sum = 0;
        for (Eigen::Index k = i + 1; k < end; ++k) sum += lower(k, i) * y[k];
        y[i] = (y[i] - sum) * inverse[i];
      }
      const double* const z = y + begin;
      for (Eigen::Index i = 0; i < begin; ++i) {
        const double* const l = lower.data() + i * n + begin;
        y[i] -= 0.0 + l[0] * z[0] + l[1] * z[1] + l[2] * z[2] + l[3] * z[3];
      }
    }
  }
}

/// Swaps row and column k with row and column `pivot` > k of a matrix of which only the lower triangle is kept.
SUREFOOT_INLINE void swap_symmetric(Eigen::MatrixXd& a, Eigen::Index k, Eigen::Index pivot) {
  for (Eigen::Index j = 0; j < k; ++j) std::swap(a(k, j), a(pivot, j));
  for (Eigen::Index i = pivot + 1; i < a.rows(); ++i) std::swap(a(i, k), a(i, pivot));
  for (Eigen::Index i = k + 1; i < pivot; ++i) std::swap(a(i, k), a(pivot, i));
  std::swap(a(k, k), a(pivot, pivot));
}

SUREFOOT_INLINE PivotedFactor factorise_with_pivots(const Eigen::MatrixXd& matrix) {
  const Eigen::Index n = matrix.rows();
  PivotedFactor result{matrix, std::vector<Eigen::Index>(static_cast<std::size_t>(n))};
  Eigen::MatrixXd& a = result.lower;
  for (Eigen::Index k = 0; k < n; ++k) result.swaps[static_cast<std::size_t>(k)] = k;
  if (n == 1) return result;
  Eigen::VectorXd scaled(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(a(i, i)) > std::abs(a(pivot, pivot))) pivot = i;
    }
    result.swaps[static_cast<std::size_t>(k)] = pivot;
    if (pivot != k) swap_symmetric(a, k, pivot);
    if (k > 0) {
      for (Eigen::Index j = 0; j < k; ++j) scaled[j] = a(j, j) * a(k, j);
      for (Eigen::Index i = k; i < n; ++i) {
        double sum = 0;
        for (Eigen::Index j = 0; j < k; ++j) sum += a(i, j) * scaled[j];
        a(i, k) -= sum;
      }
    }
    if (a(k, k) == 0 || std::isnan(a(k, k))) {
      if (k == 0) return result;  // the whole diagonal is 0
      continue;
    }
    for (Eigen::Index i = k + 1; i < n; ++i) a(i, k) /= a(k, k);
  }
  return result;
}

/// Solves for a vector, or for the columns of a matrix; where D is 0, so is the solution of its equation.
template <class VectorOrMatrix>
void solve_by_factor(const PivotedFactor& factor, VectorOrMatrix& x) {
  const Eigen::Index n = x.rows();
  const auto swap_rows = [&](Eigen::Index k) {
    const Eigen::Index other = factor.swaps[static_cast<std::size_t>(k)];
    for (Eigen::Index j = 0; j < x.cols() && other != k; ++j) std::swap(x(k, j), x(other, j));
  };
  for (Eigen::Index k = 0; k < n; ++k) swap_rows(k);
  solve_lower(factor.lower, x, DiagonalOf::ones);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double d = factor.lower(i, i);
    const bool regular = std::abs(d) > std::numeric_limits<double>::min();
    for (Eigen::Index j = 0; j < x.cols(); ++j) x(i, j) = regular ? x(i, j) / d : 0;
  }
  solve_lower_transposed(factor.lower, x, DiagonalOf::ones);
  for (Eigen::Index k = n; k-- > 0;) swap_rows(k);
}

SUREFOOT_INLINE void solve_factorised(const PivotedFactor& factor, Eigen::VectorXd& x) { solve_by_factor(factor, x); }

SUREFOOT_INLINE Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = b;
  solve_by_factor(factorise_with_pivots(a), x);
  return x;
}

SUREFOOT_INLINE Eigen::MatrixXd identity(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, columns);
  for (Eigen::Index k = 0; k < rows && k < columns; ++k) a(k, k) = 1;
  return a;
}

SUREFOOT_INLINE Eigen::MatrixXd invert_symmetric(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd x = identity(a.rows(), a.cols());
  solve_by_factor(factorise_with_pivots(a), x);
  return x;
}

SUREFOOT_INLINE bool factorise_in_place(Eigen::MatrixXd& a) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    double squares = 0;
    for (Eigen::Index j = 0; j < k; ++j) squares += a(k, j) * a(k, j);
    double pivot = a(k, k) - squares;
    if (pivot <= 0) return false;
    pivot = std::sqrt(pivot);
    a(k, k) = pivot;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      double sum = 0;
      for (Eigen::Index j = 0; j < k; ++j) sum += a(i, j) * a(k, j);
      a(i, k) = (a(i, k) - sum) / pivot;
    }
  }
  return true;
}

}  // namespace surefoot::detail
