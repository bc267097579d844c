// A point of the search moves to where its own terms are at their best.
#include "apps/diagnose/robot/search_point.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

TEST_CASE("a size that is far off settles where errors end, and other terms stay away") {
  constexpr double hidden = 1.2;  // [kg] at the tip: more than the link weighs
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 34);
  const Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  RobotPhysics physics = robot.nominal;
  physics[1][Property::payload] = hidden;
  RobotRecording& recording = evidence.recordings.back();
  recording.angle = simulate_robot(robot, recording, start_of(evidence.motions.back()), physics);
  evidence.motions.back() = smooth(recording);
  prepare(evidence);
  const auto terms = static_cast<Eigen::Index>(evidence.terms.size());
  Point point{Eigen::VectorXd::Zero(terms), TermSet(evidence.terms.size(), 0), evidence.starts, {}};
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    if (evidence.terms[t].property != Property::payload || evidence.terms[t].joints.front() != 1) continue;
    point.set[t] = 1;
    point.theta[static_cast<Eigen::Index>(t)] = hidden / 4;
  }
  const TermSet set = point.set;
  REQUIRE(std::ranges::count(set, 1) == 1);
  point.errors = errors_at(evidence, point.theta, point.starts);
  RigidCache cache;
  const LinearModel model = linearize(evidence, point.theta, point.starts, point.errors, cache);
  settle(evidence, model, 5, point);
  CHECK(point.set == set);
  CHECK(point.theta.sum() == doctest::Approx(hidden).epsilon(0.01));
  const Eigen::VectorXd settled = point.theta;
  const LinearModel there = linearize(evidence, point.theta, point.starts, point.errors, cache);
  CHECK_FALSE(move(evidence, there, set, {}, point));  // weights are those of all terms
  CHECK(point.theta == settled);
}
