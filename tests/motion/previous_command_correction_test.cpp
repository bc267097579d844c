#include "surefoot/motion/previous_command_correction.hpp"

#include <doctest/doctest.h>

using surefoot::PreviousCommandCorrection;
using surefoot::Vec;

TEST_CASE("part of the last command is carried out in the next cycle") {
  Vec<21> p = Vec<21>::Zero();
  p[1] = 2;     // dx per dx
  p[12] = 0.5;  // dx per last dx
  p[18] = 3;    // dt per last dx
  const auto model = PreviousCommandCorrection::from_parameters(p);
  CHECK(model.displacement({1, 10, 100}, {7, 0, 0}).vec() == Vec<3>{2 + 3.5, 0, 21});
  CHECK(model.present().matrix()(0, 1) == 2);
  CHECK(model.previous()(0, 0) == 0.5);
  CHECK(PreviousCommandCorrection::parameter_info()[18].name == "dt per last dx");
  CHECK(PreviousCommandCorrection::parameter_info()[18].unit == "rad/m");
}
