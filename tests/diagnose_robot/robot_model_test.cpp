#include "apps/diagnose/robot/robot_model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "apps/diagnose/robot/augmented_xml.hpp"
#include "apps/diagnose/robot/simulate_robot.hpp"
#include "surefoot/core/error.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;
using robot_test::write_text;

namespace {

template <class Work>
std::string refusal_of(const Work& work) {
  try {
    work();
  } catch (const surefoot::Error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& words) {
  CAPTURE(text);
  return text.find(words) != std::string::npos && text.find('\n') == std::string::npos;
}

double root_mean_square(const Eigen::MatrixXd& one) { return one.norm() / std::sqrt(static_cast<double>(one.size())); }

// How far the usual step leaves the motion that one of 0.1 ms gives, root mean square [rad].
double error_of_usual_step(const ScratchFolder& folder, Robot robot) {
  Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  const StartState start = start_of(evidence.motions[0]);
  const auto simulated = [&] { return simulate_robot(robot, evidence.recordings[0], start, robot.nominal); };
  const Eigen::MatrixXd usual = simulated();
  robot.setup.step = 0.0001;
  return root_mean_square(usual - simulated());
}

Robot small_robot(const ScratchFolder& folder) {
  robot_test::write_files(folder, robot_test::small_arm(), 2, 1);
  return robot_test::load(folder);
}

// The small arm and one recording, which our simulation and MuJoCo, with the corrected model, both follow.
struct FollowingArm {
  ScratchFolder folder;
  Robot robot;
  Evidence evidence;
  StartState start;

  FollowingArm() : robot(small_robot(folder)), evidence(robot) {
    robot_test::add_recording(evidence, folder.file("rec_1.csv"));
    start = start_of(evidence.motions[0]);
  }
  const RobotRecording& recording() const { return evidence.recordings[0]; }
  Eigen::MatrixXd simulated(const RobotPhysics& physics) const {
    return simulate_robot(robot, recording(), start, physics);
  }
  AugmentedModel augmented(const RobotPhysics& physics) const {
    return augmented_model(robot, physics, simulation_step(robot, recording()) / steps_of_ours.front(), folder.path());
  }
  Eigen::MatrixXd replayed(const RobotPhysics& physics) const {
    return replay(robot, augmented(physics), physics, recording(), start);
  }
};

}  // namespace

TEST_CASE("a replay that runs away ends, without a reading from there on") {
  FollowingArm arm;
  arm.start.speed[0] = 1e12;  // MuJoCo takes no more than 1e10
  const RobotPhysics physics(2);
  const Eigen::MatrixXd readings = arm.replayed(physics);
  CHECK(readings.row(0).allFinite());
  CHECK_FALSE(readings.row(1).allFinite());
  CHECK_FALSE(readings.bottomRows(1).allFinite());
}

TEST_CASE("a model that MuJoCo cannot load is refused in one sentence") {
  const ScratchFolder folder;
  for (const std::string text :
       {"<mujoco><worldbody><body></mujoco>", "nothing", "<mujoco><worldbody><body><joint/></body></worldbody>"}) {
    write_text(folder.file("robot.xml"), text);
    CHECK(contains(refusal_of([&] { load_robot(folder.file("robot.xml")); }), "robot.xml"));
  }
  write_text(folder.file("robot.xml"), "<mujoco><worldbody/></mujoco>");
  CHECK(contains(refusal_of([&] { load_robot(folder.file("robot.xml")); }), "no hinge"));
  write_text(folder.file("robot.xml"), "");
  CHECK(contains(refusal_of([&] { load_robot(folder.file("robot.xml")); }), "empty"));
  write_text(folder.file("log.csv"), "t_s,a_rad\n0,1\n");
  CHECK(contains(refusal_of([&] { load_robot(folder.file("log.csv")); }), "the robot's model first, then the log"));
  write_text(folder.file("robot.xml"), "<mujoco>\n<worldbody>\n<body name=\"a\n</mujoco>");
  CHECK(contains(refusal_of([&] { load_robot(folder.file("robot.xml")); }), "the XML breaks off in line"));
}

TEST_CASE("a model that MuJoCo's own reader fails on is refused in one sentence") {
  const ScratchFolder folder;
  write_text(folder.file("robot.urdf"),
             R"(<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="r>volute">
    <parent link="a"/><child link="b"/><limit effort="1" lower="-2" upper="2" velocity="5"/></joint></robot>)");
  CHECK(contains(refusal_of([&] { load_robot(folder.file("robot.urdf")); }), "MuJoCo cannot load it"));
}

TEST_CASE("meshes that are missing are left out") {
  const ScratchFolder folder;
  write_text(folder.file("robot.xml"), R"(<mujoco><asset><mesh name="m" file="not_there.stl"/></asset><worldbody><body>
    <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="j"/><geom type="mesh" mesh="m"/></body></worldbody></mujoco>)");
  const RobotModel robot = load_robot(folder.file("robot.xml"));
  CHECK(robot.joints.size() == 1);
  CHECK(robot.remarks.size() == 1);
}

TEST_CASE("a floating base, joints without columns, degrees and contacts are said in one sentence each") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  robot_test::write_files(folder, arm, 1, 1);
  RobotSetup setup = read_setup(folder.file("robot.toml"));
  std::string xml = blind_robots::robot_xml(arm, false);
  const RobotSetup all = setup;
  setup.joints.pop_back();
  setup.groups.pop_back();
  CHECK(contains(refusal_of([&] { bind_robot(load_robot(folder.file("robot.xml")), setup); }), "'lower'") == false);
  CHECK(contains(refusal_of([&] { bind_robot(load_robot(folder.file("robot.xml")), setup); }), "lower"));
  setup = all;
  setup.joints[0].name = "uper";
  CHECK(contains(refusal_of([&] { bind_robot(load_robot(folder.file("robot.xml")), setup); }), "did you mean 'upper'"));
  const std::string base =
      "<worldbody>\n<body name=\"base\"><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>";
  std::string floating = xml;
  floating.replace(floating.find("<worldbody>"), 11, base);
  floating.replace(floating.find("</worldbody>"), 12, "</body></worldbody>");
  write_text(folder.file("floating.xml"), floating);
  CHECK(contains(refusal_of([&] { bind_robot(load_robot(folder.file("floating.xml")), all); }), "base = \"held\""));
  RobotSetup held = all;
  held.base_held = true;
  CHECK(bind_robot(load_robot(folder.file("floating.xml")), held).joints.size() == 2);

  std::string range = xml;
  range.replace(range.find("name=\"upper\" axis"), 12, "name=\"upper\" limited=\"true\" range=\"-90 90\"");
  write_text(folder.file("range.xml"), range);
  const Robot robot = bind_robot(load_robot(folder.file("range.xml")), all);
  RobotRecording recording = read_recording(diagnose_program::read_csv(folder.file("rec_1.csv")), all, 500);
  CHECK(check_recording(robot, recording).empty());
  std::string narrow = range;
  narrow.replace(narrow.find("-90 90"), 6, "-1.5 1.5");  // radians, in a file of degrees
  write_text(folder.file("narrow.xml"), narrow);
  CHECK(
      contains(refusal_of([&] { check_recording(bind_robot(load_robot(folder.file("narrow.xml")), all), recording); }),
               "is at a stop or beyond"));
  recording.angle *= 57.3;
  CHECK(contains(refusal_of([&] { check_recording(robot, recording); }), "unit = \"deg\""));

  std::string floor = xml;
  floor.replace(floor.find("<worldbody>"), 11, "<worldbody><geom type=\"plane\" size=\"1 1 1\" pos=\"0 0 -0.3\"/>");
  floor.replace(floor.find("<site name=\"lower_end\""), 5,
                "<geom type=\"sphere\" size=\"0.1\" pos=\"0 0 -0.25\"/>\n<site");
  write_text(folder.file("floor.xml"), floor);
  recording.angle /= 57.3;
  CHECK(contains(refusal_of([&] { check_recording(bind_robot(load_robot(folder.file("floor.xml")), all), recording); }),
                 "contacts"));
}

TEST_CASE("the corrected model loads in MuJoCo and moves as the simulation that it came from") {
  const FollowingArm arm;
  RobotPhysics physics(2);
  physics[0][Property::coulomb] = 0.5;
  physics[0][Property::armature] = 0.05;
  physics[0][Property::kp_error] = -0.2;
  physics[0][Property::load_friction] = 0.1;
  physics[1][Property::viscous] = 0.3;
  physics[1][Property::delay] = 0.012;
  physics[1][Property::payload] = 0.4;
  physics[1][Property::backlash] = 0.01;
  physics[1][Property::constant_torque] = 0.2;
  const Eigen::MatrixXd ours = arm.simulated(physics), theirs = arm.replayed(physics);
  const double error = (arm.recording().angle - ours).norm();
  CHECK((ours - theirs).norm() < 0.05 * error);
  CHECK((arm.recording().angle - theirs).norm() == doctest::Approx(error).epsilon(0.02));
  CHECK(arm.augmented(physics).xml.find("frictionloss=\"0.5\"") != std::string::npos);
}

TEST_CASE("goals that arrive late are replayed as nearly as goals that do not") {
  const FollowingArm arm;
  RobotPhysics physics = arm.robot.nominal;
  const auto distance = [&] { return (arm.simulated(physics) - arm.replayed(physics)).norm(); };
  const double in_time = distance();
  for (JointPhysics& joint : physics) joint[Property::delay] = 0.0123;
  CHECK(distance() < 5 * in_time);
}

TEST_CASE("what hangs on the state within a step is replayed as it is simulated") {
  const FollowingArm arm;
  RobotPhysics physics = arm.robot.nominal;
  physics[0][Property::backlash] = 0.02;
  physics[0][Property::load_friction] = 0.2;
  physics[1][Property::drag] = 1;
  const Eigen::MatrixXd ours = arm.simulated(physics), theirs = arm.replayed(physics);
  CHECK(root_mean_square(ours - theirs) < 1.5e-5);  // [rad]
}

TEST_CASE("readings that drives act on are as old in the replay as in the simulation") {
  const FollowingArm arm;
  RobotPhysics physics = arm.robot.nominal;
  const Eigen::MatrixXd ours = arm.simulated(physics), theirs = arm.replayed(physics);
  for (JointPhysics& joint : physics) {
    joint[Property::reading_age] = 0.001;
    joint[Property::speed_age] = 0.001;
    joint[Property::goal_clock] = -0.0007;
  }
  const Eigen::MatrixXd by_age = arm.simulated(physics) - ours;
  CHECK((arm.replayed(physics) - theirs - by_age).norm() < 0.05 * by_age.norm());
}

TEST_CASE("friction by load under strong damping is simulated as shorter steps say") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  for (auto& joint : arm.joints) joint.kd *= 4;
  robot_test::write_files(folder, arm, 2, 1);
  Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  const StartState start = start_of(evidence.motions[0]);
  RobotPhysics physics = robot.nominal;
  for (JointPhysics& joint : physics) joint[Property::load_friction] = 0.2;
  const Eigen::MatrixXd usual = simulate_robot(robot, evidence.recordings[0], start, physics);
  robot.setup.step = 0.0001;
  const Eigen::MatrixXd fine = simulate_robot(robot, evidence.recordings[0], start, physics);
  CHECK((usual - fine).norm() < 0.0006);
}

TEST_CASE("a drive that reaches its torque limit is simulated as shorter steps say") {
  for (const double limit : {2.0, 0.5}) {
    const ScratchFolder folder;
    CHECK(error_of_usual_step(folder, robot_test::arm_with_limit(folder, limit)) < 1e-5);
  }
}

TEST_CASE("a drive that damps its joint within a step is simulated as shorter steps say") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.joints[1].kp *= 60;
  arm.joints[1].kd *= 60;
  robot_test::write_files(folder, arm, 2, 1);
  constexpr double encoder = 1.5e-5;  // [rad], a part of a step of 14 bits
  CHECK(error_of_usual_step(folder, robot_test::load(folder)) < encoder);
}

TEST_CASE("torques lag by as much as they should at any step, and lags below a step count") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 2, 1);
  Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  const StartState start = start_of(evidence.motions[0]);
  const auto at = [&](double lag, double step) {
    RobotPhysics physics = robot.nominal;
    for (JointPhysics& joint : physics) joint[Property::lag] = lag;
    robot.setup.step = step;
    return simulate_robot(robot, evidence.recordings[0], start, physics);
  };
  for (const double lag : {0.0005, 0.004}) {
    const Eigen::MatrixXd usual = at(lag, 0) - at(0, 0), fine = at(lag, 0.0001) - at(0, 0.0001);
    CHECK((usual - fine).norm() < 0.1 * fine.norm());
  }
}
