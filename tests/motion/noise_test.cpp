#include "surefoot/motion/noise.hpp"

#include <doctest/doctest.h>

using surefoot::MotionNoise;
using surefoot::NoiseGrowth;
using surefoot::NoiseShape;
using surefoot::Vec;

TEST_CASE("noise has the deviation it says, in either shape") {
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    const MotionNoise noise{
        .shape = shape, .constant = {0.01, 0.02, 0.03}, .per_speed = {0.02, 0, 0}, .per_acceleration = {0, 0.1, 0}};
    const Vec<3> commands{0.08, 0, 0}, previous{0, 0, 0};
    CHECK(noise.deviation(commands, previous).isApprox(Vec<3>{0.03, 0.12, 0.03}));
    surefoot::Rng rng(1);
    Vec<3> squares = Vec<3>::Zero();
    for (int i = 0; i < 20'000; ++i) squares += noise.sample(commands, previous, rng).cwiseAbs2();
    CHECK((squares / 20'000).cwiseSqrt().isApprox(noise.deviation(commands, previous), 0.03));
  }
}

TEST_CASE("noise is named in words") {
  CHECK(name_of(NoiseShape::uniform) == "uniform");
  CHECK(name_of(NoiseShape::gaussian) == "gaussian");
  CHECK(name_of(NoiseGrowth::constant) == "constant");
  CHECK(name_of(NoiseGrowth::with_speed) == "proportional to speed");
  CHECK(name_of(NoiseGrowth::with_speed_and_acceleration) == "linear in speed and acceleration");
}
