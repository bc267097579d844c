#include "surefoot/motion/plan/command_plan.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/sigmaban_walk.hpp"

using surefoot::CommandBounds;
using surefoot::commands_within;
using surefoot::MotionError;
using surefoot::plan_commands;
using surefoot::Vec;

TEST_CASE("planned commands keep their bounds and use all of them") {
  const CommandBounds bounds;
  Vec<3> low = Vec<3>::Zero(), high = Vec<3>::Zero();
  for (const Eigen::Matrix3Xd& commands : plan_commands(bounds, 50, 25, 1)) {
    CHECK(commands.cols() == 25);
    CHECK_FALSE(commands_within(bounds, commands).has_value());
    low = low.cwiseMin(commands.rowwise().minCoeff());
    high = high.cwiseMax(commands.rowwise().maxCoeff());
  }
  CHECK(low == bounds.low);
  CHECK(high == bounds.high);
}

TEST_CASE("a longer plan begins with the shorter one, and another seed plans something else") {
  const auto few = plan_commands({}, 2, 10, 7), many = plan_commands({}, 4, 10, 7), other = plan_commands({}, 2, 10, 8);
  CHECK(few[1] == many[1]);
  CHECK(few[1] != few[0]);
  CHECK(few[1] != other[1]);
}

TEST_CASE("wrong bounds and counts are refused by name") {
  CommandBounds bounds;
  bounds.low[1] = 0.01;
  CHECK_THROWS_WITH_AS(check(bounds), "CommandBounds: low of dy must be a finite number up to 0, got 0.01",
                       MotionError);
  bounds = {};
  bounds.high[0] = std::nan("");
  CHECK_THROWS_AS(check(bounds), MotionError);
  bounds = {};
  bounds.acceleration[2] = 0;
  CHECK_THROWS_WITH_AS(check(bounds),
                       "CommandBounds: acceleration of turn must be above 0 for commands that may vary, got 0",
                       MotionError);
  CHECK_THROWS_WITH_AS(plan_commands({}, 0, 25, 1), "plan_commands: sequences must be at least 1, got 0", MotionError);
  CHECK_THROWS_WITH_AS(plan_commands({}, 1, 0, 1), "plan_commands: cycles must be at least 1, got 0", MotionError);
}

TEST_CASE("commands from elsewhere are checked, and the first that breaks the bounds is named") {
  Eigen::Matrix3Xd commands = Eigen::Matrix3Xd::Zero(3, 3);
  commands.col(1) << 0.04, 0, 0;
  commands.col(2) << 0.09, 0, 0;
  CHECK(commands_within({}, commands).value() == "cycle 3: the command dx = 0.09 m lies outside [-0.04, 0.08]");
  commands.col(2) << 0.04, 0.03, 0;
  CHECK(commands_within({}, commands).value() ==
        "cycle 3: the command dy = 0.03 m differs by 0.03 from the one before, more than the 0.02 allowed");
  CHECK_FALSE(commands_within({}, commands.rightCols(1), {0.04, 0.02, 0}).has_value());
  commands(2, 0) = std::nan("");
  CHECK(commands_within({}, commands).value() == "cycle 1: the command turn = nan rad is not a number");
}

TEST_CASE("the space needed holds 99 of 100 walks, and without noise exactly the path") {
  const std::vector<Eigen::Matrix3Xd> commands = plan_commands({}, 5, 25, 3);
  const surefoot::Box<2> room = surefoot::space_needed(sigmaban::model(), sigmaban::noise(), commands, 400, 1);
  int inside = 0;
  for (std::uint64_t run = 0; run < 400; ++run) {
    for (const Eigen::Matrix3Xd& one : commands) {
      bool stays = true;
      surefoot::Rng rng(1234, run);
      surefoot::walk(
          sigmaban::model(), sigmaban::noise(), one, Vec<3>::Zero(), rng,
          [&](Eigen::Index, const surefoot::Pose2& pose) { stays = stays && room.contains(pose.position()); });
      inside += stays ? 1 : 0;
    }
  }
  CHECK(inside / 2000.0 == doctest::Approx(0.99).epsilon(0.01));

  std::vector<Eigen::Matrix3Xd> ahead{Eigen::Matrix3Xd::Zero(3, 10)};
  ahead[0].row(0).setConstant(0.04);
  const surefoot::Box<2> line = surefoot::space_needed(sigmaban::Model(), surefoot::MotionNoise(), ahead, 2, 1);
  CHECK(line.low() == Vec<2>{0, 0});
  CHECK(line.high()[0] == doctest::Approx(0.4));
  CHECK(line.high()[1] == 0);
  CHECK_THROWS_AS(surefoot::space_needed(sigmaban::Model(), surefoot::MotionNoise(), ahead, 0, 1), MotionError);
}
