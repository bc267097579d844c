// Definitions of surefoot/core/positive_definite.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/positive_definite.hpp"

namespace surefoot::detail {

constexpr std::size_t panel = 4;  // rows of the triangular factor that are solved together

/// A = L L^T; the lower half of A becomes L. Stops at a pivot that is not positive.
inline void decompose(std::span<double> a, std::size_t size) {
  const auto at = [&](std::size_t row, std::size_t column) -> double& { return a[column * size + row]; };
  for (std::size_t k = 0; k < size; ++k) {
    double squares = 0;
    for (std::size_t j = 0; j < k; ++j) squares += at(k, j) * at(k, j);
    double pivot = at(k, k);
    if (k > 0) pivot -= squares;
    if (pivot <= 0) return;
    pivot = std::sqrt(pivot);
    at(k, k) = pivot;
    for (std::size_t i = k + 1; i < size; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < k; ++j) sum += at(i, j) * at(k, j);
      at(i, k) = (at(i, k) - sum) / pivot;
    }
  }
}

/// L y = b, panel by panel from the top; within one the columns of L, below it sums over the panel.
inline void solve_lower(std::span<const double> l, std::size_t size, double* y) {
  for (std::size_t begin = 0; begin < size; begin += panel) {
    const std::size_t end = std::min(size, begin + panel);
    for (std::size_t i = begin; i < end; ++i) {
      y[i] *= 1 / l[i * size + i];
      for (std::size_t k = i + 1; k < end; ++k) y[k] -= y[i] * l[i * size + k];
    }
    for (std::size_t i = end; i < size; ++i) {
      double sum = 0;
      for (std::size_t k = begin; k < end; ++k) sum += l[k * size + i] * y[k];
      y[i] -= sum;
    }
  }
}

/// L^T x = y, panel by panel from the bottom.
inline void solve_upper(std::span<const double> l, std::size_t size, double* x) {
  for (std::size_t end = size; end > 0;) {
    const std::size_t begin = end - std::min(end, panel);
    for (std::size_t i = end; i-- > begin;) {
      double sum = 0;
      for (std::size_t k = i + 1; k < end; ++k) sum += l[i * size + k] * x[k];
      x[i] = (x[i] - sum) * (1 / l[i * size + i]);
    }
    for (std::size_t i = 0; i < begin; ++i) {
      double sum = 0;
      for (std::size_t k = begin; k < end; ++k) sum += l[i * size + k] * x[k];
      x[i] -= sum;
    }
    end = begin;
  }
}

SUREFOOT_INLINE void solve_positive_definite(std::span<double> a, std::size_t size, std::span<double> b,
                                             std::size_t columns) {
  decompose(a, size);
  for (std::size_t column = 0; column < columns; ++column) {
    solve_lower(a, size, b.data() + column * size);
    solve_upper(a, size, b.data() + column * size);
  }
}

}  // namespace surefoot::detail
