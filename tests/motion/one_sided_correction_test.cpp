#include "surefoot/motion/one_sided_correction.hpp"

#include <doctest/doctest.h>

using surefoot::OneSidedCorrection;
using surefoot::Vec;

TEST_CASE("a gain of one side adds to that side and takes from the other") {
  Vec<24> parameters = OneSidedCorrection().parameters();
  parameters[23] = 0.2;  // dt per |dt|
  const auto model = OneSidedCorrection::from_parameters(parameters);
  CHECK(model.displacement({0, 0, 0.5}, {0, 0, 0}).angle == doctest::Approx(0.6));
  CHECK(model.displacement({0, 0, -0.5}, {0, 0, 0}).angle == doctest::Approx(-0.4));
  CHECK(model.displacement({0.1, 0, 0}, {0, 0, 0}).x == doctest::Approx(0.1));
  CHECK((model.parameters() - parameters).norm() == 0);
  CHECK(OneSidedCorrection::parameter_info()[23].name == "dt per |dt|");
}
