#include "surefoot/motion/simulate_walk.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "surefoot/motion/plan/command_plan.hpp"
#include "tests/support/sigmaban_walk.hpp"

using surefoot::PoseAccuracy;
using surefoot::WalkSequence;

TEST_CASE("a walk without noise ends where the model says") {
  const Eigen::Matrix3Xd commands = surefoot::plan_commands({}, 1, 25, 1)[0];
  surefoot::Rng rng(1);
  const WalkSequence walked =
      surefoot::simulate_walk(sigmaban::model(), surefoot::MotionNoise(), PoseAccuracy{.position = 0, .heading = 0},
                              surefoot::planned_sequence(commands, true), rng);
  CHECK(walked.poses.allFinite());
  CHECK((walked.poses.col(24) - surefoot::predict_final_pose(sigmaban::model(), walked).vec()).norm() < 1e-12);
}

TEST_CASE("only what was measured in the example is measured") {
  WalkSequence planned = surefoot::planned_sequence(surefoot::plan_commands({}, 1, 5, 1)[0], false);
  planned.poses(2, 4) = std::nan("");
  surefoot::Rng rng(1);
  const WalkSequence walked =
      surefoot::simulate_walk(sigmaban::model(), sigmaban::noise(), PoseAccuracy(), planned, rng);
  CHECK(walked.poses.leftCols(4).array().isNaN().all());
  CHECK(walked.position_measured(4));
  CHECK_FALSE(walked.heading_measured(4));
}

TEST_CASE("a heading with a tolerance is read off as the middle of its bin") {
  const double tolerance = std::numbers::pi / 6;
  surefoot::Rng rng(1);
  for (const Eigen::Matrix3Xd& commands : surefoot::plan_commands({}, 20, 25, 1)) {
    const WalkSequence walked =
        surefoot::simulate_walk(sigmaban::model(), sigmaban::noise(), PoseAccuracy{.heading_tolerance = tolerance},
                                surefoot::planned_sequence(commands, false), rng);
    const double bins = walked.poses(2, 24) / (2 * tolerance);
    CHECK(std::abs(bins - std::round(bins)) < 1e-9);
  }
}
