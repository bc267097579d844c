#include "surefoot/optimize/symmetric_eigen.hpp"

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

TEST_CASE("eigenvalues and eigenvectors are Eigen's to the last bit") {
  for (const Eigen::Index n : {1, 2, 3, 7, 12, 40}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n);
    a += a.transpose().eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> expected(a);
    const surefoot::detail::SymmetricEigen found = surefoot::detail::eigen_of_symmetric(a);
    CHECK(found.values == expected.eigenvalues());
    CHECK(found.vectors == expected.eigenvectors());
  }
}
