// Definitions of surefoot/optimize/symmetric_eigen.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/householder.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot::detail {

/// A symmetric matrix as Q T Q^T with a tridiagonal T, scaled so that no element is larger than 1.
struct TridiagonalForm {
  Eigen::MatrixXd reflections;  // by column and below its subdiagonal: the vectors of Householder, after a leading 1
  Eigen::VectorXd factors;      // of the reflections
  Eigen::VectorXd diagonal, subdiagonal;
  double scale = 1;
};

SUREFOOT_INLINE TridiagonalForm tridiagonal_form(const Eigen::MatrixXd& symmetric) {
  using LowerTimesVector = Eigen::internal::selfadjoint_matrix_vector_product<double, Eigen::Index, Eigen::ColMajor,
                                                                              Eigen::Lower, false, false>;
  const Eigen::Index n = symmetric.rows();
  TridiagonalForm form{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd(n - 1), Eigen::VectorXd(n), Eigen::VectorXd(n - 1)};
  Eigen::MatrixXd& a = form.reflections;
  Eigen::VectorXd& w = form.factors;
  double largest = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) largest = std::max(largest, std::abs(symmetric(i, j)));
  }
  if (largest > 0) form.scale = largest;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) a(i, j) = symmetric(i, j) / form.scale;
  }
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const Eigen::Index rest = n - k - 1;
    double* const v = &a(k + 1, k);
    double factor = 0;
    reflect(v, rest, factor);
    form.subdiagonal[k] = v[0];
    v[0] = 1;
    for (Eigen::Index i = 0; i < rest; ++i) w[k + i] = 0;
    LowerTimesVector::run(rest, &a(k + 1, k + 1), n, v, &w[k], factor);
    const double along = factor * -0.5 * dot(&w[k], v, rest);
    for (Eigen::Index i = 0; i < rest; ++i) w[k + i] += along * v[i];
    for (Eigen::Index j = 0; j < rest; ++j) {
      for (Eigen::Index i = j; i < rest; ++i) a(k + 1 + i, k + 1 + j) += -v[j] * w[k + i] + -w[k + j] * v[i];
    }
    w[k] = factor;
  }
  for (Eigen::Index k = 0; k < n; ++k) form.diagonal[k] = a(k, k);
  return form;
}

/// Q of the tridiagonal form.
SUREFOOT_INLINE Eigen::MatrixXd product_of_reflections(const TridiagonalForm& form) {
  const Eigen::Index n = form.diagonal.size();
  Eigen::MatrixXd q = identity(n, n);
  for (Eigen::Index k = n - 1; k-- > 0;) {
    const double* const rest = k + 2 < n ? &form.reflections(k + 2, k) : nullptr;
    apply_reflection(rest, form.factors[k], q, k + 1, k + 1);
  }
  return q;
}

/// The rotation (c, s) that makes (x, z) a multiple of (1, 0).
SUREFOOT_INLINE std::pair<double, double> rotation(double x, double z) {
  if (z == 0) return {x < 0 ? -1 : 1, 0};
  if (x == 0) return {0, z < 0 ? 1 : -1};
  if (std::abs(x) > std::abs(z)) {
    const double t = z / x, u = std::copysign(std::sqrt(1 + t * t), x);
    return {1 / u, -t * (1 / u)};
  }
  const double t = x / z, s = -1 / std::copysign(std::sqrt(1 + t * t), z);
  return {-t * s, s};
}

/// Wilkinson's shift: the eigenvalue of the last two rows and columns that is nearer to the last element.
SUREFOOT_INLINE double shift(double before_last, double beside, double last) {
  const double half = (before_last - last) * 0.5;
  if (half == 0) return last - std::abs(beside);
  if (beside == 0) return last;
  const double larger = std::max(std::abs(half), std::abs(beside)),
               ratio = std::min(std::abs(half), std::abs(beside)) / larger;
  const double length = larger * std::sqrt(1 + ratio * ratio), sum = half + (half > 0 ? length : -length);
  const double square = beside * beside;
  return square == 0 ? last - beside / (sum / beside) : last - square / sum;
}

/// A QR step on rows begin to end of a tridiagonal matrix; the columns of `vectors`, if any, turn along.
SUREFOOT_INLINE void qr_step(Eigen::VectorXd& diagonal, Eigen::VectorXd& sub, Eigen::Index begin, Eigen::Index end,
                             Eigen::MatrixXd* vectors) {
  double x = diagonal[begin] - shift(diagonal[end - 1], sub[end - 1], diagonal[end]);
  double z = sub[begin];
  for (Eigen::Index k = begin; k < end && z != 0; ++k) {
    const auto [c, s] = rotation(x, z);
    const double left = s * diagonal[k] + c * sub[k], right = s * sub[k] + c * diagonal[k + 1];
    diagonal[k] = c * (c * diagonal[k] - s * sub[k]) - s * (c * sub[k] - s * diagonal[k + 1]);
    diagonal[k + 1] = s * left + c * right;
    sub[k] = c * left - s * right;
    if (k > begin) sub[k - 1] = c * sub[k - 1] - s * z;
    x = sub[k];
    if (k < end - 1) {
      z = -s * sub[k + 1];
      sub[k + 1] = c * sub[k + 1];
    }
    for (Eigen::Index i = 0; vectors && i < vectors->rows(); ++i) {
      const double p = (*vectors)(i, k), q = (*vectors)(i, k + 1);
      (*vectors)(i, k) = c * p - s * q;
      (*vectors)(i, k + 1) = s * p + c * q;
    }
  }
}

/// Turns the diagonal of a tridiagonal matrix into its eigenvalues, unsorted if they are not found in 30 n steps.
SUREFOOT_INLINE void diagonalise(Eigen::VectorXd& diagonal, Eigen::VectorXd& sub, Eigen::MatrixXd* vectors) {
  constexpr double precision_inverse = 1 / std::numeric_limits<double>::epsilon();
  const Eigen::Index n = diagonal.size();
  Eigen::Index begin = 0, end = n - 1;
  for (Eigen::Index steps = 0; end > 0; ++steps) {
    for (Eigen::Index i = begin; i < end; ++i) {
      const double scaled = precision_inverse * sub[i];
      if (std::abs(sub[i]) < std::numeric_limits<double>::min() ||
          scaled * scaled <= std::abs(diagonal[i]) + std::abs(diagonal[i + 1])) {
        sub[i] = 0;
      }
    }
    while (end > 0 && sub[end - 1] == 0) --end;
    if (end == 0) break;
    if (steps >= 30 * n) return;
    begin = end - 1;
    while (begin > 0 && sub[begin - 1] != 0) --begin;
    qr_step(diagonal, sub, begin, end, vectors);
  }
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    Eigen::Index least = i;
    for (Eigen::Index k = i + 1; k < n; ++k) {
      if (diagonal[k] < diagonal[least]) least = k;
    }
    if (least == i) continue;
    std::swap(diagonal[i], diagonal[least]);
    for (Eigen::Index row = 0; vectors && row < n; ++row) std::swap((*vectors)(row, i), (*vectors)(row, least));
  }
}

SUREFOOT_INLINE SymmetricEigen eigen_of_symmetric(const Eigen::MatrixXd& a) {
  TridiagonalForm form = tridiagonal_form(a);
  SymmetricEigen result{{}, product_of_reflections(form)};
  diagonalise(form.diagonal, form.subdiagonal, &result.vectors);
  result.values = std::move(form.diagonal);
  if (a.rows() == 1) {
    result.values[0] = a(0, 0);
  } else {
    for (double& value : result.values) value *= form.scale;
  }
  return result;
}

SUREFOOT_INLINE double condition_of_symmetric(const Eigen::MatrixXd& a) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (a.rows() == 1) return a(0, 0) > 0 ? 1 : infinity;
  TridiagonalForm form = tridiagonal_form(a);
  diagonalise(form.diagonal, form.subdiagonal, nullptr);
  double least = form.diagonal[0], most = least;
  for (const double value : form.diagonal) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  const double smallest = form.scale * least;
  return smallest > 0 ? form.scale * most / smallest : infinity;
}

}  // namespace surefoot::detail
