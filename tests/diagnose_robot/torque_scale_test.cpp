// Recorded torques that are currents, or of the other sign.
#include "apps/diagnose/robot/torque_scale.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

// An arm that torques drive, with friction that the model lacks; its log has them by these factors.
std::vector<int> other_scales(double upper, double lower, bool calibrated = false) {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.torque_driven = true;
  arm.joints[0].hidden.coulomb = 1.5;
  arm.joints[1].hidden.mass_error = 0.5;
  robot_test::write_files(folder, arm, 36);
  Robot robot = robot_test::load(folder);
  robot.setup.calibrate_gains = calibrated;
  robot.setup.calibrate_bodies = false;
  Evidence evidence(robot);
  for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
    robot_test::add_recording(evidence, folder.file(file));
    RobotRecording& recording = evidence.recordings.back();
    recording.torque.col(0) *= upper;
    recording.torque.col(1) *= lower;
    evidence.motions.back() = smooth(recording);
  }
  prepare(evidence);
  return joints_of_other_scale(evidence);
}

}  // namespace

TEST_CASE("torques on a scale that no mass and no friction explain are told, unless scales are calibrated anyway") {
  CHECK(other_scales(1, 1).empty());
  CHECK(other_scales(0.07, 1) == std::vector<int>{0});
  CHECK(other_scales(1, -1) == std::vector<int>{1});
  CHECK(other_scales(0.07, -0.1) == std::vector<int>{0, 1});
  CHECK(other_scales(0.07, -0.1, true).empty());
}
