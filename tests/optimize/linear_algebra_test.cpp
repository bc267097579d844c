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
    CHECK(factor == expected);
  }
}
