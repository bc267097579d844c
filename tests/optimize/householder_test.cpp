#include "surefoot/optimize/householder.hpp"

#include <doctest/doctest.h>

#include <Eigen/QR>

#include "surefoot/optimize/linear_algebra.hpp"

namespace detail = surefoot::detail;

TEST_CASE("a reflection turns its own vector into a multiple of the first axis and keeps lengths") {
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(6, 3);
  const Eigen::MatrixXd before = a;
  Eigen::VectorXd v = before.col(0);
  double factor = 0;
  detail::reflect(v.data(), v.size(), factor);
  detail::apply_reflection(v.data() + 1, factor, a, 0, 0);
  CHECK(a(0, 0) == doctest::Approx(v[0]));
  CHECK(a.col(0).tail(5).norm() < 1e-14);
  for (Eigen::Index j = 0; j < 3; ++j) CHECK(a.col(j).norm() == doctest::Approx(before.col(j).norm()));
}

TEST_CASE("an orthonormal basis is Eigen's to the last bit") {
  for (const Eigen::Index rows : {1, 3, 8, 200}) {
    for (const Eigen::Index columns : {1, 2, 7, 30}) {
      const Eigen::MatrixXd a = Eigen::MatrixXd::Random(rows, columns);
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> expected(a);
      const Eigen::MatrixXd basis = expected.householderQ() * Eigen::MatrixXd::Identity(rows, expected.rank());
      CHECK(detail::orthonormal_basis(a) == basis);
    }
  }
}

TEST_CASE("a basis has as many vectors as columns are independent") {
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(20, 5);
  a.col(3) = a.col(0) - 2 * a.col(4);
  a.col(1).setZero();
  const Eigen::MatrixXd basis = detail::orthonormal_basis(a);
  REQUIRE(basis.cols() == 3);
  CHECK((basis.transpose() * basis - Eigen::MatrixXd::Identity(3, 3)).norm() < 1e-14);
  CHECK((a - basis * (basis.transpose() * a)).norm() < 1e-13);
  CHECK(detail::orthonormal_basis(Eigen::MatrixXd::Zero(4, 2)).cols() == 0);
}
