// Tests of surefoot/diagnose/estimation/exponentials.hpp.
#include "surefoot/diagnose/estimation/exponentials.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/rng.hpp"

namespace surefoot::diagnosis {

TEST_CASE("exponentials and logarithms are those of Eigen's arrays, to the last bit") {
  Rng rng(1);
  for (Eigen::Index count = 0; count < 70; ++count) {
    Eigen::VectorXd x(count);
    for (double& value : x) value = 8 * rng.normal();
    const Eigen::VectorXd powers = x.array().exp();
    CHECK(exponentials(x) == powers);
    const Eigen::VectorXd back = powers.array().log();
    CHECK(logarithms(powers) == back);
  }
}

}  // namespace surefoot::diagnosis
