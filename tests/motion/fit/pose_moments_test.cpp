#include "surefoot/motion/fit/pose_moments.hpp"

#include <doctest/doctest.h>

#include <cmath>

using surefoot::Vec;

TEST_CASE("straight ahead the mean of where the robot may be falls short, and it is unsure along the track too") {
  surefoot::detail::PoseMoments moments;
  Vec<3> mean = Vec<3>::Zero();
  const surefoot::Pose2 step{0.1, 0, 0};
  const double turn = 0.1;
  moments.move(mean, step, Vec<3>(0, 0, turn * turn));
  moments.move(mean, step, Vec<3>(0, 0, 0));
  CHECK(mean[0] == doctest::Approx(0.1 + 0.1 * std::exp(-0.005)));
  // x = 0.1 cos(turn): variance (1 - exp(-variance))^2 / 2; y = 0.1 sin(turn): (1 - exp(-2 variance)) / 2
  CHECK(moments.covariance()(0, 0) == doctest::Approx(0.01 * std::pow(1 - std::exp(-0.01), 2) / 2));
  CHECK(moments.covariance()(1, 1) == doctest::Approx(0.01 * (1 - std::exp(-0.02)) / 2));
  CHECK(moments.covariance()(1, 2) == doctest::Approx(0.1 * 0.01 * std::exp(-0.005)));
}
