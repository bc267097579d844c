// Definitions of surefoot/motion/monitor/cholesky.hpp.
#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE Cholesky::Cholesky(const Eigen::MatrixXd& a) : lower_(a) { ok_ = factorise_in_place(lower_); }

SUREFOOT_INLINE void Cholesky::solve_in_place(Eigen::MatrixXd& b) const {
  lower_.triangularView<Eigen::Lower>().solveInPlace(b);
  lower_.triangularView<Eigen::Lower>().adjoint().solveInPlace(b);
}

SUREFOOT_INLINE Eigen::MatrixXd Cholesky::inverse() const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(lower_.rows(), lower_.cols());
  solve_in_place(result);
  return result;
}

/// Calls work(std::integral_constant<int, n>) for a size n of the smaller motion models of the library, whose kernels
/// are unrolled, and of Eigen::Dynamic for any other.
template <class Work>
auto with_size(Eigen::Index n, Work&& work) {
  if (n == 3) return work(std::integral_constant<int, 3>());
  if (n == 6) return work(std::integral_constant<int, 6>());
  return work(std::integral_constant<int, Eigen::Dynamic>());
}

/// Views of the same numbers, of size n or Eigen::Dynamic.
template <int n>
Eigen::Map<const Eigen::Matrix<double, n, 1>> view(const Eigen::VectorXd& a) {
  return {a.data(), a.size()};
}
template <int n>
Eigen::Map<const Eigen::Matrix<double, n, n>> view(const Eigen::MatrixXd& a) {
  return {a.data(), a.rows(), a.cols()};
}

SUREFOOT_INLINE Eigen::VectorXd Cholesky::solve_lower(const Eigen::VectorXd& b) const {
  return with_size(b.size(), [&](auto n) {
    Eigen::Matrix<double, n.value, 1> x = b;
    view<n.value>(lower_).template triangularView<Eigen::Lower>().solveInPlace(x);
    return Eigen::VectorXd(x);
  });
}

SUREFOOT_INLINE Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  return with_size(b.size(), [&](auto n) {
    Eigen::Matrix<double, n.value, 1> x = b;
    const auto lower = view<n.value>(lower_).template triangularView<Eigen::Lower>();
    lower.solveInPlace(x);
    lower.adjoint().solveInPlace(x);
    return Eigen::VectorXd(x);
  });
}

SUREFOOT_INLINE Eigen::VectorXd multiply(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  return with_size(x.size(), [&](auto n) {
    const Eigen::Matrix<double, n.value, 1> product = view<n.value>(a) * view<n.value>(x);
    return Eigen::VectorXd(product);
  });
}

SUREFOOT_INLINE Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return with_size(a.rows(), [&](auto n) {
    const Eigen::Matrix<double, n.value, n.value> product = view<n.value>(a) * view<n.value>(b);
    return Eigen::MatrixXd(product);
  });
}

SUREFOOT_INLINE double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  // The sizes of the larger models too: unrolled.
  if (a.size() == 12) return view<12>(a).dot(view<12>(b));
  if (a.size() == 21) return view<21>(a).dot(view<21>(b));
  return with_size(a.size(), [&](auto n) { return view<n.value>(a).dot(view<n.value>(b)); });
}

SUREFOOT_INLINE double squared_norm(const Eigen::VectorXd& a) { return dot(a, a); }

}  // namespace surefoot::detail
