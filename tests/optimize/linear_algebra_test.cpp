#include "surefoot/optimize/linear_algebra.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

TEST_CASE("symmetric systems are solved, and positive definite ones recognised") {
  Eigen::MatrixXd a{{4, 2}, {2, 3}};
  CHECK((a * surefoot::detail::solve_symmetric(a, Eigen::Vector2d(1, 2)) - Eigen::Vector2d(1, 2)).norm() < 1e-12);
  CHECK((a * surefoot::detail::invert_symmetric(a) - Eigen::Matrix2d::Identity()).norm() < 1e-12);
  CHECK(surefoot::detail::factorise_in_place(a));
  CHECK(a(0, 0) == 2);
  a << 1, 2, 2, 1;
  CHECK_FALSE(surefoot::detail::factorise_in_place(a));
}

TEST_CASE("solutions and factors are Eigen's to the last bit") {
  for (const Eigen::Index n : {1, 2, 3, 6, 9, 31, 32, 50}) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::Random(n, n);
    const Eigen::MatrixXd a = root * root.transpose();
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    CHECK(surefoot::detail::solve_symmetric(a, b) == a.ldlt().solve(b));
    CHECK(surefoot::detail::invert_symmetric(a) == a.ldlt().solve(Eigen::MatrixXd::Identity(n, n)));
    Eigen::MatrixXd factor = a, expected = a;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(expected);
    CHECK(surefoot::detail::factorise_in_place(factor) == (in_place.info() == Eigen::Success));
    if (n < 32) CHECK(factor == expected);  // larger ones Eigen takes by blocks
    CHECK((factor - expected).norm() <= 1e-12 * expected.norm());
  }
}

// Equal to the last bit where Eigen sums one product after the other: where rows, columns and products are few.
void check_product(const Eigen::MatrixXd& product, const Eigen::MatrixXd& expected, Eigen::Index depth) {
  if (product.rows() == 1 || product.rows() + product.cols() + depth < 20) CHECK(product == expected);
  CHECK((product - expected).norm() <= 1e-14 * expected.norm());
}

TEST_CASE("products are Eigen's, few to the last bit") {
  for (const Eigen::Index n : {1, 2, 3, 5, 12, 30}) {
    for (const Eigen::Index m : {2, 7, 60}) {
      const Eigen::MatrixXd a = Eigen::MatrixXd::Random(m, n), b = Eigen::MatrixXd::Random(m, n);
      const Eigen::VectorXd x = Eigen::VectorXd::Random(m), y = Eigen::VectorXd::Random(n);
      const Eigen::MatrixXd turned = a.transpose();
      CHECK(surefoot::detail::transposed(a) == turned);
      check_product(surefoot::detail::product(turned, b), turned * b, m);
      check_product(surefoot::detail::transposed_product(a, b), a.transpose() * b, m);
      CHECK(surefoot::detail::transposed_product(a, x) == a.transpose() * x);
      Eigen::MatrixXd apart = a;  // columns of different rows
      for (Eigen::Index j = 0; j < n; j += 2) apart.col(j).head(m / 2).setZero();
      for (Eigen::Index j = 1; j < n; j += 3) apart.col(j).tail(m - m / 3).setZero();
      const Eigen::MatrixXd square = surefoot::detail::weighted_square(apart, x);
      CHECK((square - apart.transpose() * x.asDiagonal() * apart).norm() <= 1e-14 * a.squaredNorm());
      CHECK(square == square.transpose());
      CHECK(surefoot::detail::product(a, y) == a * y);
      CHECK(surefoot::detail::norm(x) == x.norm());
      CHECK(surefoot::detail::column_norm(a, n - 1) == a.col(n - 1).norm());
      CHECK(surefoot::detail::scaled(y, turned * a) == y.asDiagonal() * (turned * a) * y.asDiagonal());
      Eigen::VectorXd sum = y;
      sum.noalias() += (turned * a).eval().triangularView<Eigen::Lower>() * y;
      CHECK(surefoot::detail::add_lower_product(y, turned * a, y) == sum);
    }
  }
}
