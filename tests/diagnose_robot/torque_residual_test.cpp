#include "apps/diagnose/robot/torque_residual.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "apps/diagnose/robot/low_pass.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

struct TorqueArm {
  ScratchFolder folder;
  Robot robot;
  Motion motion;

  explicit TorqueArm(double load_friction = 0) {
    auto arm = robot_test::small_arm();
    arm.torque_driven = true;
    for (auto& joint : arm.joints) joint.hidden.load_friction = load_friction;
    robot_test::write_files(folder, arm, 22, 1);
    robot = robot_test::load(folder);
    Evidence evidence(robot);
    robot_test::add_recording(evidence, folder.file("rec_1.csv"));
    motion = evidence.motions[0];
  }
};

double rms_of_known(const Eigen::VectorXd& x) {
  double square = 0, rows = 0;
  for (const double one : x) {
    if (!std::isfinite(one)) continue;
    square += one * one;
    rows += 1;
  }
  return std::sqrt(square / rows);
}

}  // namespace

TEST_CASE("a low-pass filter leaves what does not change, and takes nothing from rows that are not known") {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(101, 0, 1);
  Eigen::VectorXd torque = Eigen::VectorXd::Constant(101, 3);
  torque[40] = std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd filtered = low_passed(time, 0.1, torque);
  CHECK(std::isnan(filtered[40]));
  for (Eigen::Index k = 0; k < 101; ++k) {
    if (k != 40) CHECK(filtered[k] == doctest::Approx(3));
  }
  surefoot::Rng rng(3);
  for (double& one : torque) one = rng.normal();
  CHECK(low_passed(time, 0, torque).isApprox(torque));
  CHECK(rms_of_known(low_passed(time, 0.1, torque)) < 0.4);
}

TEST_CASE("a low-pass filter is as wide as noise asks for and torque allows") {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(1001, 0, 10);
  const Eigen::VectorXd slow = (2 * time.array()).sin(), fast = (40 * time.array()).sin();
  const auto falls = [](double width) { return 0.1 / (1 + 100 * width); };
  CHECK(low_pass_width(time, slow, [](double) { return 0.005; }) == 0);
  const double width = low_pass_width(time, slow, falls);
  CHECK(falls(width) > 0.004);
  CHECK(width > 0.08);
  CHECK(low_pass_width(time, fast, falls) < 0.03);
}

TEST_CASE("of an arm that is as its model says, little but the share of noise that no drive repeats is left") {
  const TorqueArm arm;
  const Eigen::MatrixXd left = low_passed(arm.motion, torque_residual(arm.robot, arm.motion, arm.robot.nominal));
  for (Eigen::Index j = 0; j < left.cols(); ++j)
    CHECK(rms_of_known(left.col(j)) < 0.02 * rms_of_known(arm.motion.torque.col(j)));
}

TEST_CASE("friction by load is a share of the torque that the drive gives, itself included") {
  constexpr double share = 0.3;
  const TorqueArm arm(share);
  RobotPhysics physics(arm.robot.joints.size());
  for (std::size_t j = 0; j < physics.size(); ++j) {
    physics[j] = arm.robot.nominal[j];
    physics[j][Property::load_friction] = share;
  }
  const Eigen::MatrixXd left = low_passed(arm.motion, torque_residual(arm.robot, arm.motion, physics));
  for (Eigen::Index j = 0; j < left.cols(); ++j)
    CHECK(rms_of_known(left.col(j)) < 0.02 * rms_of_known(arm.motion.torque.col(j)));
}

TEST_CASE("rows whose window a reversal lies in say nothing: their friction is a mixture") {
  const TorqueArm arm;
  const Motion& motion = arm.motion;
  const Eigen::MatrixXd left = torque_residual(arm.robot, motion, RobotPhysics(arm.robot.joints.size()));
  for (Eigen::Index j = 0; j < left.cols(); ++j) {
    for (Eigen::Index k = 1; k < left.rows(); ++k) {
      if (motion.v(k, j) * motion.v(k - 1, j) >= 0) continue;
      for (Eigen::Index i = k; i < left.rows() && motion.time[i] - motion.time[k - 1] < motion.reach; ++i)
        CHECK(std::isnan(left(i, j)));
    }
  }
}
