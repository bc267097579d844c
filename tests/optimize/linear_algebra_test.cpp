#include "surefoot/optimize/linear_algebra.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

TEST_CASE("the condition of a symmetric matrix is that of its eigenvalues, and infinite where it is not positive") {
  for (const Eigen::Index n : {1, 2, 5, 40}) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::Random(n, n);
    const Eigen::MatrixXd a = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues();
    CHECK(surefoot::detail::condition_of_symmetric(a) == doctest::Approx(values[n - 1] / values[0]));
    CHECK(std::isinf(surefoot::detail::condition_of_symmetric(-a)));
  }
}

TEST_CASE("symmetric systems are solved, and positive definite ones recognised") {
  Eigen::MatrixXd a{{4, 2}, {2, 3}};
  CHECK((a * surefoot::detail::solve_symmetric(a, Eigen::Vector2d(1, 2)) - Eigen::Vector2d(1, 2)).norm() < 1e-12);
  CHECK((a * surefoot::detail::invert_symmetric(a) - Eigen::Matrix2d::Identity()).norm() < 1e-12);
  CHECK(surefoot::detail::factorise_in_place(a));
  CHECK(a(0, 0) == 2);
  a << 1, 2, 2, 1;
  CHECK_FALSE(surefoot::detail::factorise_in_place(a));
}
