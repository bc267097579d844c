// How far simulations of one model may be apart.
#include "apps/diagnose/robot/numerical_error.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

TEST_CASE("simulations differ by no more than joints leave room for, but for the worse of two") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 33);
  const Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  prepare(evidence);
  evidence.numerical = Eigen::VectorXd::Constant(2, 0.01);
  Eigen::MatrixXd errors = Eigen::MatrixXd::Constant(evidence.recordings[0].time.size(), 2, 0.002);
  CHECK(numerical_share(evidence, errors) == doctest::Approx(0.2).epsilon(0.05));
  errors.col(1).setConstant(0.012);
  CHECK(numerical_share(evidence, errors) == 1);
  CHECK_FALSE(lower_numerical_error(evidence, errors));
  errors.col(1).setConstant(0.004);
  CHECK(lower_numerical_error(evidence, errors));
  CHECK(evidence.numerical[0] == doctest::Approx(0.004).epsilon(0.05));
  errors.col(1).setConstant(0.05);  // unexplained all the same
  CHECK(lower_numerical_error(evidence, errors));
  CHECK(evidence.numerical[0] == doctest::Approx(0.002).epsilon(0.05));
}

TEST_CASE("simulations of a drive that is at its limit differ by more than those of the file as it stands") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.joints[0].limit = 20;
  robot_test::write_files(folder, arm, 33);
  const Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  prepare(evidence);
  evidence.numerical = numerical_error(evidence, robot.nominal, evidence.starts);
  const double as_it_stands = evidence.numerical[0];
  RobotPhysics weak = robot.nominal;
  weak[0][Property::torque_limit] = 0.975;
  const Eigen::MatrixXd left = Eigen::MatrixXd::Constant(evidence.recordings[0].time.size(), 2, 0.01),
                        nothing = Eigen::MatrixXd::Constant(left.rows(), 2, 0.0);
  CHECK_FALSE(raise_numerical_error(evidence, weak, evidence.starts, nothing, 1));  // which leaves no room for it
  CHECK(evidence.numerical[0] == as_it_stands);
  CHECK(raise_numerical_error(evidence, weak, evidence.starts, left, 1));
  CHECK(evidence.numerical[0] > 1.25 * as_it_stands);
  CHECK_FALSE(raise_numerical_error(evidence, weak, evidence.starts, left, 1));
  CHECK_FALSE(raise_numerical_error(evidence, robot.nominal, evidence.starts, left, 1));
}
