#include "surefoot/motion/fit/pose_filter.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::MotionNoise;
using surefoot::PoseAccuracy;
using surefoot::Vec;
using surefoot::WalkSequence;

TEST_CASE("what exact poses leave is each cycle's own deviation, seen in the frame before it") {
  const auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 1, 3);
  MotionNoise noise;
  noise.constant = {0.01, 0.02, 0.05};
  const auto found = innovations(toys::paper_walk(), noise, PoseAccuracy{.position = 0, .heading = 0}, walks[0]);
  REQUIRE(found.size() == 25);
  surefoot::Pose2 from;
  for (const auto& innovation : found) {
    const auto to = surefoot::Pose2::from_vec(walks[0].poses.col(innovation.cycle));
    const Vec<3> commands = walks[0].commands.col(innovation.cycle);
    Vec<3> deviation = (from.inverse() * to).vec() - toys::paper_walk().displacement(commands).vec();
    deviation[2] = surefoot::wrap_angle(deviation[2]);
    CHECK(innovation.whitened().squaredNorm() ==
          doctest::Approx(deviation.cwiseQuotient(noise.constant).squaredNorm()).epsilon(1e-6));
    from = to;
  }
}

TEST_CASE("final poses are as far from the model as the filter expects, also where the heading is quite unsure") {
  constexpr int count = 4000;
  const MotionNoise noise{.constant = {0.0115, 0.02, 0.09}};  // after 25 cycles the heading is off by 26 degrees
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), square = Eigen::Vector3d::Zero();
  for (WalkSequence walk : toys::walks(toys::paper_walk(), noise, count, 4)) {
    walk = final_pose_only(walk);
    const auto found = innovations(toys::paper_walk(), noise, PoseAccuracy{.position = 0, .heading = 0}, walk);
    REQUIRE(found.size() == 1);
    const Eigen::Vector3d whitened = found[0].whitened();
    mean += whitened / count;
    square += whitened.cwiseAbs2() / count;
  }
  // Independent components of mean 0 and variance 1: standard errors 0.016 and about 0.022.
  CHECK(mean.lpNorm<Eigen::Infinity>() < 0.06);
  CHECK((square.array() - 1).matrix().lpNorm<Eigen::Infinity>() < 0.1);
}

TEST_CASE("without a measured heading only the position counts") {
  auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 1, 5));
  walks[0].poses(2, 24) = std::nan("");
  const auto found = innovations(toys::paper_walk(), MotionNoise{.constant = {0.01, 0.01, 0.05}}, {}, walks[0]);
  REQUIRE(found.size() == 1);
  CHECK(found[0].error.size() == 2);
}

TEST_CASE("the likelihood is that of a normal distribution") {
  WalkSequence sequence{.name = "one cycle"};
  sequence.commands = Vec<3>{0.1, 0, 0};
  sequence.poses = Vec<3>{0.13, -0.01, 0.02};
  const MotionNoise noise{.constant = {0.03, 0.01, 0.05}};
  const PoseAccuracy accuracy{.position = 0.04, .heading = 0.12, .heading_tolerance = 0};
  const auto density = [](double error, double variance) {
    return -0.5 * (error * error / variance + std::log(2 * std::numbers::pi * variance));
  };
  CHECK(log_likelihood(surefoot::FullLinearCorrection(), noise, accuracy, std::vector{sequence}) ==
        doctest::Approx(density(0.03, 0.0025) + density(0.01, 0.0017) + density(0.02, 0.0169)));
}
