#include "surefoot/motion/plan/informative_commands.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <span>
#include <vector>

#include "tests/support/sigmaban_walk.hpp"

using surefoot::InformativeOptions;
using surefoot::MotionError;
using surefoot::Vec;

using Tracker = surefoot::MotionTracker;

namespace {

/// A robot with the paper's noise that nothing else is known of.
Tracker uncalibrated() {
  Tracker tracker{.model = sigmaban::Model()};
  tracker.noise = sigmaban::noise();
  tracker.forgetting = 1;
  return tracker;
}

}  // namespace

TEST_CASE("held commands keep the bounds of the robot") {
  for (const Eigen::Matrix3Xd& commands : surefoot::plan_held_commands({}, 50, 25, 1)) {
    CHECK_FALSE(surefoot::commands_within({}, commands).has_value());
  }
}

TEST_CASE("final poses of chosen commands calibrate better than those of commands that wander") {
  const std::vector<Eigen::Matrix3Xd> chosen =
      surefoot::plan_informative_commands(uncalibrated(), InformativeOptions{.candidates = 100}, 1);
  REQUIRE(chosen.size() == 25);
  const auto errors = [](const std::vector<Eigen::Matrix3Xd>& plan) {
    const auto sequences = sigmaban::walked(sigmaban::model(), sigmaban::noise(), plan, false, 1);
    return surefoot::fit_model<sigmaban::Model>(sequences, sigmaban::noise()).standard_errors();
  };
  const Vec<12> better = errors(chosen), worse = errors(surefoot::plan_commands({}, 25, 25, 1));
  for (const int i : {1, 6}) CHECK(better[i] < 0.8 * worse[i]);
  CHECK(better[11] < worse[11]);
}

TEST_CASE("chosen commands stay within reach by the model, and the choice depends on the seed alone") {
  InformativeOptions options{.sequences = 5, .candidates = 100, .reach = 0.5};
  const auto chosen = surefoot::plan_informative_commands(uncalibrated(), options, 1);
  CHECK(chosen == surefoot::plan_informative_commands(uncalibrated(), options, 1));
  for (const Eigen::Matrix3Xd& commands : chosen) {
    const auto room = surefoot::space_needed(sigmaban::Model(), surefoot::MotionNoise(), std::span(&commands, 1), 1, 1);
    CHECK(room.high().maxCoeff() <= 0.5);
    CHECK(room.low().minCoeff() >= -0.5);
  }
  options = {.candidates = 1, .reach = 0.001};
  CHECK_THROWS_WITH_AS(
      surefoot::plan_informative_commands(uncalibrated(), options, 1),
      "InformativeOptions: no candidate stays within the reach of 0.001 m; allow more, or fewer cycles", MotionError);
  options = {.sequences = 0};
  CHECK_THROWS_AS(surefoot::plan_informative_commands(uncalibrated(), options, 1), MotionError);
}

TEST_CASE("check walks see the change that is hardest to see several times better than walks that wander") {
  Tracker tracker = uncalibrated();
  tracker.model = sigmaban::model();
  const InformativeOptions options{.sequences = 10, .candidates = 100};
  const auto calibrating = surefoot::plan_informative_commands(tracker, InformativeOptions{.candidates = 100}, 2);
  for (const auto& sequence : sigmaban::walked(sigmaban::model(), sigmaban::noise(), calibrating, false, 1)) {
    update(tracker, sequence);
  }
  Vec<12> jumps = Vec<12>::Zero();
  for (const int i : {1, 6, 11}) jumps[i] = 0.2 * sigmaban::model().parameters()[i];
  const surefoot::CheckPlan plan = surefoot::plan_check_commands(tracker, jumps, options, 1);
  CHECK(plan.commands.size() == 10);

  Eigen::MatrixXd together = Eigen::MatrixXd::Zero(12, 12);
  for (const auto& sequence :
       sigmaban::walked(sigmaban::model(), sigmaban::noise(), surefoot::plan_commands({}, 10, 25, 1), false, 1)) {
    together += linearize(tracker, sequence).information;
  }
  const Eigen::MatrixXd information = tracker.information * (tracker.information + together).llt().solve(together);
  double wandering = std::numeric_limits<double>::infinity();
  for (const int i : {1, 6, 11}) wandering = std::min(wandering, jumps[i] * jumps[i] * information(i, i));
  CHECK(plan.seen > 3 * wandering);
  CHECK_THROWS_AS(surefoot::plan_check_commands(tracker, Vec<12>(Vec<12>::Zero()), options, 1), MotionError);
}
