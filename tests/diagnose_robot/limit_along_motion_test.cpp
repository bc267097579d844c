// The torque limit that a measured motion shows.
#include "apps/diagnose/robot/limit_along_motion.hpp"

#include <doctest/doctest.h>

#include "apps/diagnose/robot/search_terms.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

constexpr double stated = 60, hidden = 2.3;  // [N m]

// The upper joint's drive gives less than it should, and the log as it would be.
struct WeakArm {
  ScratchFolder folder;
  Robot robot;
  Evidence evidence;

  WeakArm() : robot(robot_test::arm_with_limit(folder, stated)), evidence(robot) {
    RobotPhysics physics = robot.nominal;
    physics[0][Property::torque_limit] = 1 - hidden / stated;
    for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
      robot_test::add_recording(evidence, folder.file(file));
      RobotRecording& recording = evidence.recordings.back();
      recording.angle = simulate_robot(robot, recording, start_of(evidence.motions.back()), physics);
      evidence.motions.back() = smooth(recording);
    }
    prepare(evidence);
  }
};

}  // namespace

TEST_CASE("a torque limit far below the stated one, which no derivative shows, is seen along the motion and found") {
  const WeakArm arm;
  const std::vector<double> limits = limits_along_motion(arm.evidence, arm.robot.nominal, 0);
  REQUIRE(!limits.empty());
  CHECK(limits.front() == doctest::Approx(hidden).epsilon(0.2));
  const SearchResult found = search_terms(arm.evidence, [](const std::string&, double) {});
  const RobotPhysics physics = physics_of(arm.evidence.terms, found.theta, arm.robot.nominal);
  CHECK(stated * (1 - physics[0][Property::torque_limit]) == doctest::Approx(hidden).epsilon(0.01));
}
