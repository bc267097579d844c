#include "surefoot/motion/monitor/cholesky.hpp"

#include <doctest/doctest.h>

using surefoot::detail::Cholesky;

TEST_CASE("every size is factorised and solved, those with kernels of their own and any other") {
  for (const Eigen::Index n : {1, 3, 4, 6, 12, 21}) {
    CAPTURE(n);
    const Eigen::MatrixXd root = Eigen::MatrixXd::Random(n, n);
    const Eigen::MatrixXd a = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    const Cholesky cholesky(a);
    REQUIRE(cholesky.ok());
    CHECK((a * cholesky.solve(b) - b).norm() < 1e-10);
    CHECK((a * cholesky.inverse() - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-9);
    const Eigen::MatrixXd lower = cholesky.lower().triangularView<Eigen::Lower>();
    CHECK((lower * cholesky.solve_lower(b) - b).norm() < 1e-10);
    CHECK(surefoot::detail::multiply(a, b).isApprox(a * b));
    CHECK(surefoot::detail::multiply(a, root).isApprox(a * root));
    CHECK(surefoot::detail::squared_norm(b) == doctest::Approx(b.squaredNorm()));
  }
  CHECK_FALSE(Cholesky(-Eigen::MatrixXd::Identity(3, 3)).ok());
}
