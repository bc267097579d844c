#include "surefoot/core/positive_definite.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cstddef>

namespace surefoot::detail {
namespace {

Eigen::MatrixXd solved(Eigen::MatrixXd a, Eigen::MatrixXd b) {
  solve_positive_definite({a.data(), static_cast<std::size_t>(a.size())}, static_cast<std::size_t>(a.rows()),
                          {b.data(), static_cast<std::size_t>(b.size())}, static_cast<std::size_t>(b.cols()));
  return b;
}

Eigen::MatrixXd random_positive_definite(int size) {
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(size, size + 3);
  return root * root.transpose();
}

#ifndef __AVX__  // with wider vectors Eigen adds in another order
TEST_CASE("small systems have the solutions of Eigen's Cholesky decomposition to the last bit") {
  for (int size = 1; size < 32; ++size) {
    for (int columns = 1; columns < 6; ++columns) {
      const Eigen::MatrixXd a = random_positive_definite(size);
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(size, columns);
      const Eigen::MatrixXd expected = a.llt().solve(b);
      CHECK(solved(a, b) == expected);
    }
  }
}
#endif

TEST_CASE("large systems are solved") {
  const Eigen::MatrixXd a = random_positive_definite(100);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(100, 3);
  CHECK((a * solved(a, b) - b).norm() < 1e-9 * b.norm());
}

}  // namespace
}  // namespace surefoot::detail
