// Arithmetic on small vectors: the same as Eigen's, component by component.
#include "surefoot/diagnose/simulation/small_vectors.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace surefoot::diagnosis {
namespace {

const Eigen::Vector3d from(1, 2, 3), rate(0.5, -1, 4);

TEST_CASE("a move is the product of time and rate") {
  CHECK(moved(from, 0.25, rate) == from + 0.25 * rate);
  CHECK(moved(Eigen::VectorXd(from), 0.25, Eigen::VectorXd(rate)) == from + 0.25 * rate);
}

TEST_CASE("four equal stages of Runge and Kutta are one") {
  CHECK((moved(from, 0.3, rate, rate, rate, rate) - (from + 0.3 * rate)).norm() < 1e-15);
}

TEST_CASE("vectors are copied and added to at one component") {
  Eigen::Vector3d sum = copied(from);
  add_at(sum, 1, 10);
  CHECK(sum == Eigen::Vector3d(1, 12, 3));
  assign(sum, rate);
  CHECK(sum == rate);
}

TEST_CASE("one number that is not finite is enough") {
  CHECK(all_finite(from));
  CHECK_FALSE(all_finite(Eigen::Vector2d(1, std::numeric_limits<double>::infinity())));
  CHECK_FALSE(all_finite(Eigen::Vector2d(std::numeric_limits<double>::quiet_NaN(), 1)));
}

}  // namespace
}  // namespace surefoot::diagnosis
