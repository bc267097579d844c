// Whether recorded torques stand until the next row.
#include "apps/diagnose/robot/torque_hold.hpp"

#include <doctest/doctest.h>

#include "apps/diagnose/robot/choose_terms.hpp"
#include "apps/diagnose/robot/search_terms.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

// An arm that torques drive, whose log tells them earlier [s] than they act.
struct EarlyTorques {
  ScratchFolder folder;
  Robot robot;
  Evidence evidence;

  explicit EarlyTorques(double rows) : robot(made(folder)), evidence(robot) {
    for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
      robot_test::add_recording(evidence, folder.file(file));
      RobotRecording& recording = evidence.recordings.back();
      const Eigen::MatrixXd torque = recording.torque;
      const auto whole = static_cast<Eigen::Index>(rows);
      const double part = rows - static_cast<double>(whole);
      for (Eigen::Index k = 0; k + whole + 1 < torque.rows(); ++k)
        recording.torque.row(k) = (1 - part) * torque.row(k + whole) + part * torque.row(k + whole + 1);
      evidence.motions.back() = smooth(recording);
    }
    prepare(evidence);
  }

  static Robot made(const ScratchFolder& folder) {
    auto arm = robot_test::small_arm();
    arm.torque_driven = true;
    arm.joints[0].hidden.coulomb = 0.5;
    robot_test::write_files(folder, arm, 31);
    return robot_test::load(folder);
  }
};

}  // namespace

TEST_CASE("torques that stand until the next row act half a row late, and readings do not") {
  EarlyTorques held(0.5), read(0);
  CHECK(evidence_for_held_torques(held.evidence) > ChoiceCriteria().needed);
  CHECK(evidence_for_held_torques(read.evidence) < 0);
  CHECK(hold_torques(held.evidence));
  CHECK(held.evidence.motions[1].torque_late == doctest::Approx(held.evidence.recordings[1].row_period() / 2));
  CHECK_FALSE(hold_torques(read.evidence));
  CHECK(read.evidence.motions[0].torque_late == 0);
}

TEST_CASE("torques that arrive late are found, with the friction beside them") {
  constexpr double rows = 3;
  const EarlyTorques late(rows);
  const SearchResult found = search_terms(late.evidence, [](const std::string&, double) {});
  const RobotPhysics physics = physics_of(late.evidence.terms, found.theta, late.robot.nominal);
  const double delay = rows * late.evidence.recordings[0].row_period();
  for (const JointPhysics& joint : physics) CHECK(joint[Property::delay] == doctest::Approx(delay).epsilon(0.1));
  CHECK(physics[0][Property::coulomb] == doctest::Approx(0.5).epsilon(0.1));
}
