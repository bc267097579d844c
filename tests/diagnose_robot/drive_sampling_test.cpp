// Drives that compute: between two ticks of their loop they hold their torque.
#include <doctest/doctest.h>

#include <algorithm>

#include "apps/diagnose/robot/search_terms.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

constexpr double tick = 0.5e-3, fine = 0.1e-3;  // [s] of the loop, and of a Runge-Kutta integration
constexpr double noise = 1e-4;                  // [rad]

// The angles that an arm which is as its model says follows the goals of a recording with.
Eigen::MatrixXd held_between_ticks(const Robot& robot, const RobotRecording& recording, const StartState& start) {
  const ModelPointer model = model_with_bodies(robot, robot.nominal);
  model->opt.timestep = fine;
  model->opt.integrator = mjINT_RK4;
  const DataPointer data(mj_makeData(model.get()));
  mjData* d = data.get();
  const auto joints = static_cast<Eigen::Index>(robot.joints.size());
  for (Eigen::Index j = 0; j < joints; ++j) {
    const RobotJoint& joint = robot.joints[static_cast<std::size_t>(j)];
    model->dof_armature[joint.model.dof] = blind_robots::file_armature;
    d->qpos[joint.model.position] = start.angle[j];
    d->qvel[joint.model.dof] = start.speed[j];
  }
  Eigen::MatrixXd angle(recording.angle.rows(), joints);
  const auto per_tick = static_cast<int>(std::lround(tick / fine));
  const auto per_row = static_cast<int>(std::lround(recording.row_period() / fine));
  for (Eigen::Index k = 0; k < angle.rows(); ++k) {
    for (int step = 0; step < per_row; ++step) {
      for (Eigen::Index j = 0; j < joints; ++j) {
        const RobotJoint& joint = robot.joints[static_cast<std::size_t>(j)];
        const double q = d->qpos[joint.model.position];
        if (step == 0) angle(k, j) = q;
        if (step % per_tick == 0)
          d->qfrc_applied[joint.model.dof] =
              joint.setup.kp * (recording.goal(k, j) - q) - joint.setup.kd * d->qvel[joint.model.dof];
      }
      mj_step(model.get(), d);
    }
  }
  return angle;
}

}  // namespace

TEST_CASE(
    "a drive that holds its torque for half a millisecond acts on readings half as old, and nothing else is missing") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 37);
  const Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  surefoot::Rng rng(38);
  for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
    robot_test::add_recording(evidence, folder.file(file));
    RobotRecording& recording = evidence.recordings.back();
    recording.angle = held_between_ticks(robot, recording, start_of(evidence.motions.back()));
    for (double& reading : recording.angle.reshaped()) reading += noise * rng.normal();
    evidence.motions.back() = smooth(recording);
  }
  prepare(evidence);
  const SearchResult found = search_terms(evidence, [](const std::string&, double) {});
  REQUIRE(std::ranges::count(found.set, 1) == 1);
  const auto at = std::ranges::find(found.set, 1) - found.set.begin();
  CHECK(evidence.terms[static_cast<std::size_t>(at)].property == Property::reading_age);
  CHECK(found.theta[at] == doctest::Approx(tick / 2).epsilon(0.1));
}
