#include "surefoot/optimize/numeric_jacobian.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>

namespace surefoot {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd curved(const VectorXd& x) { return VectorXd{{std::sin(x[0]) * x[1], std::exp(x[1]), x[0] * x[0] * x[0]}}; }
MatrixXd curved_slopes(const VectorXd& x) {
  return MatrixXd{{std::cos(x[0]) * x[1], std::sin(x[0])}, {0, std::exp(x[1])}, {3 * x[0] * x[0], 0}};
}

TEST_CASE("the Jacobian is right to nine digits") {
  for (const VectorXd& x : {VectorXd{{0.3, -1.2}}, VectorXd{{0, 0}}, VectorXd{{2, 3}}}) {
    CHECK((numeric_jacobian(curved, x) - curved_slopes(x)).cwiseAbs().maxCoeff() <
          1e-9 * (1 + curved_slopes(x).norm()));
  }
}

TEST_CASE("with a box no point outside is evaluated and faces have a Jacobian too") {
  const Box<Eigen::Dynamic> box{VectorXd{{0, -1}}, VectorXd{{1, 2}}};
  const auto checked = [&](const VectorXd& x) {
    CHECK(box.contains(x));
    return curved(x);
  };
  for (const VectorXd& x : {VectorXd{{0, 2}}, VectorXd{{1, -1}}, VectorXd{{0.5, 1}}}) {
    CHECK((numeric_jacobian(checked, x, box) - curved_slopes(x)).cwiseAbs().maxCoeff() < 2e-4);
  }
}

TEST_CASE("a dimension without width has derivative 0") {
  const Box<Eigen::Dynamic> box{VectorXd{{0, 1}}, VectorXd{{1, 1}}};
  const MatrixXd slopes = numeric_jacobian(curved, VectorXd{{0.5, 1}}, box);
  CHECK(slopes.col(1).isZero());
  CHECK(slopes(2, 0) == doctest::Approx(0.75));
}

}  // namespace
}  // namespace surefoot
