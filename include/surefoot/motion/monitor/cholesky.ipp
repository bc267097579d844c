// Definitions of surefoot/motion/monitor/cholesky.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE Cholesky::Cholesky(const Eigen::MatrixXd& a) : lower_(a) { ok_ = factorise_in_place(lower_); }

SUREFOOT_INLINE double Cholesky::half_log_determinant() const {
  double sum = 0;
  for (Eigen::Index i = 0; i < lower_.rows(); ++i) sum += std::log(lower_(i, i));
  return sum;
}

SUREFOOT_INLINE void Cholesky::solve_in_place(Eigen::MatrixXd& b) const {
  detail::solve_lower(lower_, b);
  solve_lower_transposed(lower_, b);
}

SUREFOOT_INLINE Eigen::MatrixXd Cholesky::inverse() const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(lower_.rows(), lower_.cols());
  solve_in_place(result);
  return result;
}

// The smaller motion models of the library have 3 or 6 parameters. Their sums are taken as Eigen takes those of
// matrices of a fixed size: half plus half, so that results stay equal to the last bit to those of the releases that
// used them.

SUREFOOT_INLINE bool is_small(Eigen::Index n) { return n == 3 || n == 6; }

/// The sum of a[i step_a] b[i step_b] for i < count, half plus half.
SUREFOOT_INLINE double halved_dot(const double* a, Eigen::Index step_a, const double* b, Eigen::Index step_b,
                                  Eigen::Index count) {
  if (count == 1) return a[0] * b[0];
  const Eigen::Index half = count / 2;
  return halved_dot(a, step_a, b, step_b, half) +
         halved_dot(a + half * step_a, step_a, b + half * step_b, step_b, count - half);
}

/// The same of the even and of the odd i apart, and the last one where their number is odd.
SUREFOOT_INLINE double halved_dot_by_two(const double* a, const double* b, Eigen::Index count) {
  if (count == 1) return a[0] * b[0];
  const double sum = halved_dot(a, 2, b, 2, count / 2) + halved_dot(a + 1, 2, b + 1, 2, count / 2);
  return count % 2 == 0 ? sum : sum + a[count - 1] * b[count - 1];
}

SUREFOOT_INLINE Eigen::VectorXd Cholesky::solve_lower(const Eigen::VectorXd& b) const {
  const Eigen::Index n = b.size();
  Eigen::VectorXd x = b;
  if (!is_small(n)) {
    detail::solve_lower(lower_, x);
    return x;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i > 0) x[i] -= halved_dot(&lower_(i, 0), n, &x[0], 1, i);
    x[i] /= lower_(i, i);
  }
  return x;
}

SUREFOOT_INLINE Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  const Eigen::Index n = b.size();
  Eigen::VectorXd x = solve_lower(b);
  if (!is_small(n)) {
    solve_lower_transposed(lower_, x);
    return x;
  }
  for (Eigen::Index i = n; i-- > 0;) {
    if (i + 1 < n) x[i] -= halved_dot_by_two(&lower_(i + 1, i), &x[i + 1], n - i - 1);
    x[i] /= lower_(i, i);
  }
  return x;
}

/// result = a x: sums from the first column on, in the last row of 3 of the last two first.
SUREFOOT_INLINE void multiply(const Eigen::MatrixXd& a, const double* x, double* result) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    double sum = 0;
    for (Eigen::Index j = 0; j < n; ++j) sum += a(i, j) * x[j];
    result[i] = sum;
  }
  if (n == 3) result[2] = halved_dot(&a(2, 0), n, x, 1, n);
}

SUREFOOT_INLINE Eigen::VectorXd multiply(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  Eigen::VectorXd product(a.rows());
  multiply(a, x.data(), product.data());
  return product;
}

SUREFOOT_INLINE Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::Index n = a.rows();
  if (n > 6) return a * b;
  Eigen::MatrixXd product(n, n);
  for (Eigen::Index j = 0; j < n; ++j) multiply(a, &b(0, j), &product(0, j));
  return product;
}

SUREFOOT_INLINE double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index n = a.size();
  const bool fixed = is_small(n) || n == 12 || n == 21;  // the sizes of the larger models too
  return fixed ? halved_dot_by_two(a.data(), b.data(), n) : dot(a.data(), b.data(), n);
}

SUREFOOT_INLINE double squared_norm(const Eigen::VectorXd& a) { return dot(a, a); }

}  // namespace surefoot::detail
