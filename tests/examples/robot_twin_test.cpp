// The robot in MuJoCo. Its walk is chaotic and differs between machines: statistics are compared, not trajectories.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "apps/calibrate/load_sequences.hpp"
#include "examples/sigmaban/approach/winner2016.hpp"
#include "examples/sigmaban/twin/mjcf.hpp"
#include "examples/sigmaban/twin/play_approach.hpp"
#include "examples/sigmaban/twin/share.hpp"
#include "examples/sigmaban/twin/twin_sequence.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/motion/plan.hpp"
#include "tests/support/program.hpp"

using namespace sigmaban;
using surefoot::Pose2, surefoot::Vec;

namespace {

WalkingTwinOptions with(double TwinSwitches::*member, double value) {
  WalkingTwinOptions options;
  options.switches.*member = value;
  return options;
}

/// Mean displacement of a cycle while one command per step is repeated.
Vec<3> mean_cycle(const WalkingTwinOptions& options, const Vec<3>& command, int cycles = 8) {
  WalkingTwin robot(options);
  robot.cycle(command);
  Vec<3> sum = Vec<3>::Zero();
  for (int i = 0; i < cycles; ++i) sum += robot.cycle(command).vec();
  CHECK(!robot.fallen());
  return sum / cycles;
}

/// Root mean square of what servos lag behind their targets, walking on the spot [rad].
double lag(const WalkingTwinOptions& options) {
  WalkingTwin robot(options);
  SplineWalk engine(options.walk);
  double squares = 0;
  int count = 0;
  robot.cycle(Vec<3>::Zero(), [&](const Twin& twin) {
    const auto targets = engine.step({}, twin.parameters().order_period)->array();
    const auto positions = twin.joint_positions();
    for (std::size_t i = 0; i < 12; ++i, ++count) squares += std::pow(targets[i] - positions[i], 2);
  });
  return std::sqrt(squares / count);
}

const std::vector<TwinSequence>& random_walks() {
  static const std::vector<TwinSequence> walks =
      record_sequences({}, surefoot::plan_commands(surefoot::CommandBounds(), 8, 25, 3), 3, surefoot::Threads());
  return walks;
}

std::string refusal(const std::string& text) {
  TwinSwitches switches;
  try {
    set_switch(switches, text);
  } catch (const TwinError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("the twin weighs 4.2 kg and stands still on level ground") {
  Twin twin;
  CHECK(twin.mass() == doctest::Approx(4.2).epsilon(1e-9));
  const auto stand = SplineWalk(twin_walk()).step({.enabled = 0}, 0);
  REQUIRE(stand);
  twin.reset(*stand);
  for (int i = 0; i < 100; ++i) twin.drive(*stand);
  const Pose2 settled = twin.pose();
  const double height = twin.height();
  for (int i = 0; i < 200; ++i) twin.drive(*stand);
  CHECK(!twin.fallen());
  CHECK(twin.time() == doctest::Approx(3));
  CHECK((twin.pose().vec() - settled.vec()).norm() < 1e-3);
  CHECK(std::abs(twin.height() - height) < 1e-3);
  CHECK(height > 0.19);
  CHECK(height < 0.23);
}

TEST_CASE("straight legs reach from the hips to the ground") {
  const Twin twin;
  CHECK(twin.height() == doctest::Approx(0.230).epsilon(1e-6));
  CHECK(std::abs(twin.soles()[0].z()) < 1e-9);
  CHECK(twin.soles()[0].y() == doctest::Approx(0.046 + 0.005));
  CHECK(twin.soles()[1].y() == doctest::Approx(-0.046 - 0.005));
}

TEST_CASE("a robot that leans over falls, and is said to have fallen") {
  Twin twin;
  JointTargets leaning;
  leaning.left.ankle_pitch = leaning.right.ankle_pitch = 1.0;
  for (int i = 0; i < 300; ++i) twin.drive(leaning);
  CHECK(twin.fallen());
}

TEST_CASE("the twin walks as it is told, but for its gains") {
  CHECK(mean_cycle({}, {0.02, 0, 0})[0] / 0.04 == doctest::Approx(1.06).epsilon(0.2));
  CHECK(mean_cycle({}, {0, 0.015, 0})[1] / 0.03 == doctest::Approx(1.15).epsilon(0.2));
  CHECK(mean_cycle({}, {0, 0, 0.15})[2] / 0.3 == doctest::Approx(0.78).epsilon(0.2));
  CHECK(mean_cycle({}, {0, 0, 0}).norm() < 0.02);
}

TEST_CASE("random commands: no falls, gains near those of the recordings") {
  int falls = 0;
  for (const TwinSequence& sequence : random_walks()) falls += sequence.fell ? 1 : 0;
  CHECK(falls == 0);
  const auto gains = walk_gains(random_walks());
  CHECK(std::abs(gains(0, 1) - 1.06) < 0.2);
  CHECK(std::abs(gains(1, 2) - 1.15) < 0.2);
  CHECK(std::abs(gains(2, 3) - 0.78) < 0.2);
}

TEST_CASE("a slope is gravity that leans") {
  TwinSwitches switches;
  switches.slope_forward = 0.1;
  switches.slope_left = -0.05;
  const Vec<3> gravity = Twin({}, switches).gravity();
  CHECK(gravity.norm() == doctest::Approx(9.81));
  CHECK(gravity[0] == doctest::Approx(9.81 * std::sin(0.1)));
  CHECK(gravity[1] == doctest::Approx(-9.81 * std::sin(0.05)));
  const auto leaning = [](const TwinSwitches& ground) {  // servos give way
    Twin twin({}, ground);
    for (int i = 0; i < 50; ++i) twin.drive({});
    return twin.pose().x;
  };
  CHECK(leaning(with(&TwinSwitches::slope_forward, 0.03).switches) > leaning({}) + 0.001);
}

TEST_CASE("a shorter leg hangs in the air while the other stands") {
  const Twin twin({}, with(&TwinSwitches::short_left_leg, 0.002).switches);
  CHECK(twin.soles()[0].z() == doctest::Approx(0.002));
  CHECK(std::abs(twin.soles()[1].z()) < 1e-9);
}

TEST_CASE("commands take effect after the delay") {
  WalkingTwin robot(with(&TwinSwitches::order_delay, 2));
  const Vec<3> ahead(0.04, 0, 0);
  double early = robot.cycle(ahead).x;
  early += robot.cycle(ahead).x;
  CHECK(std::abs(early) < 0.04);
  CHECK(robot.cycle(ahead).x + robot.cycle(ahead).x > 0.08);
}

TEST_CASE("servos lag more with friction, and with a low battery") {
  const double plain = lag({});
  CHECK(lag(with(&TwinSwitches::servo_friction, 0.3)) > 1.1 * plain);
  CHECK(lag(with(&TwinSwitches::battery_drop, 4)) > 1.1 * plain);
}

TEST_CASE("free play is a joint of its own behind every servo, and lets the standing robot sway") {
  const WalkingTwinOptions loose = with(&TwinSwitches::backlash, 0.02);
  CHECK(mjcf({}, loose.switches).find("left_knee_play") != std::string::npos);
  CHECK(mjcf({}, {}).find("_play\"") == std::string::npos);
  const WalkingTwin robot(loose);
  CHECK(!robot.fallen());
  CHECK(mean_cycle(loose, {0.02, 0, 0})[0] > 0.02);
}

TEST_CASE("on a slippery ground a turn comes to less") {
  CHECK(mean_cycle(with(&TwinSwitches::slippery_radius, 50), {0, 0, 0.15})[2] < 0.9 * mean_cycle({}, {0, 0, 0.15})[2]);
}

TEST_CASE("stabilised walks under pushes: the centre of pressure comes to the middle of the feet, and fewer fall") {
  WalkingTwinOptions options;
  options.pushes.impulse = 1;
  const auto commands = surefoot::plan_commands(surefoot::CommandBounds(), 12, 12, 5);
  const auto falls = [&](bool stabilized) {
    options.stabilized = stabilized;
    const auto walks = record_sequences(options, commands, 5, surefoot::Threads());
    return std::ranges::count_if(walks, &TwinSequence::fell);
  };
  const auto without = falls(false);
  CHECK(without >= 4);
  CHECK(falls(true) <= without / 2);
}

TEST_CASE("the feet carry the robot, and its sensors say so") {
  Twin twin;
  const auto stand = SplineWalk(twin_walk()).step({.enabled = 0}, 0);
  REQUIRE(stand);
  twin.reset(*stand);
  for (int i = 0; i < 200; ++i) twin.drive(*stand);
  const BodyReading& reading = twin.reading();
  CHECK(reading.loads[0] + reading.loads[1] == doctest::Approx(4.2 * 9.81).epsilon(0.01));
  CHECK(reading.pressure_x[0] > 0.01);  // it stands over its toes
  CHECK(reading.accelerometer.norm() == doctest::Approx(9.81).epsilon(0.01));
  CHECK(reading.accelerometer.x() < -1);  // leaning forwards
  CHECK(reading.gyro.norm() < 0.01);
  twin.push({20, 0, 0});
  twin.drive(*stand);
  CHECK(reading.gyro.y() > 0.01);
}

TEST_CASE("a robot sinks into soft ground and still walks") {
  const WalkingTwinOptions soft = with(&TwinSwitches::soft_ground, 0.03);
  Twin twin({}, soft.switches);
  const Twin hard;
  for (int i = 0; i < 50; ++i) twin.drive({});
  CHECK(twin.height() < hard.height() - 0.0005);
  CHECK(mean_cycle(soft, {0.02, 0, 0})[0] > 0.02);
}

TEST_CASE("a switch of one joint acts there alone, and the log of the joints shows it") {
  TwinSwitches switches;
  set_switch(switches, "servo_friction:left_knee=0.3");
  CHECK(switches.servo_friction == 0.3);
  CHECK(joint_names[static_cast<std::size_t>(switches.joint)] == "left_knee");
  const std::string xml = mjcf({}, switches);
  CHECK(xml.find("frictionloss=\"0.39\"") == xml.rfind("frictionloss=\"0.39\""));
  CHECK_THROWS_WITH_AS(set_switch(switches, "backlash:right_knee"), doctest::Contains("give one joint alone"),
                       TwinError);
  CHECK_THROWS_WITH_AS(set_switch(switches, "soft_ground:left_knee"), doctest::Contains("has no joint"), TwinError);

  WalkingTwinOptions options;
  set_switch(options.switches, "joint_zero:left_knee=0.05");
  const Eigen::Matrix3Xd commands = Eigen::Matrix3Xd::Zero(3, 2);
  const TwinSequence moved = record_sequence(options, commands, 0, 1, true),
                     plain = record_sequence({}, commands, 0, 1, true);
  REQUIRE(moved.joints.size() == plain.joints.size());
  const std::size_t knee = 3;
  double told = 0;
  for (std::size_t i = 0; i < moved.joints.size(); ++i) {
    told = std::max(told, std::abs(moved.joints[i].goals[knee] - plain.joints[i].goals[knee]));
    CHECK(std::abs(moved.joints[i].goals[knee] - moved.joints[i].positions[knee]) < 0.2);  // by its own zero
  }
  CHECK(told < 1e-9);  // the goals are the same, the leg is not
  const TwinSequence sequences[] = {moved};
  const std::string csv = joints_csv(sequences);
  CHECK(csv.starts_with("seq,t_s,goal_left_hip_yaw_rad"));
  CHECK(csv.find("current_right_ankle_roll_A") != std::string::npos);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == static_cast<std::ptrdiff_t>(moved.joints.size()) + 1);
}

TEST_CASE("switches by name: a usual value, a given one, and what is no switch") {
  TwinSwitches switches;
  set_switch(switches, "backlash");
  set_switch(switches, "slope_left=-0.05");
  CHECK(switches.backlash > 0);
  CHECK(switches.slope_left == -0.05);
  CHECK(refusal("wind") ==
        "switch wind: there is no such switch; there are backlash, servo_friction, joint_zero, order_delay, "
        "slope_forward, slope_left, short_left_leg, battery_drop, soft_ground, slippery_radius");
  CHECK(refusal("backlash=much").find("a number was expected") != std::string::npos);
  CHECK(refusal("backlash=-1").find("from 0 to 0.1 rad, got -1") != std::string::npos);
  CHECK(refusal("order_delay=1.5").find("whole number") != std::string::npos);
  CHECK_THROWS_AS(Twin({}, with(&TwinSwitches::battery_drop, 13).switches), TwinError);
}

TEST_CASE("parameters and commands that cannot be are refused") {
  TwinParameters heavy;
  heavy.shin.mass = -1;
  CHECK_THROWS_AS(Twin{heavy}, TwinError);
  WalkingTwin robot;
  CHECK_THROWS_AS(robot.cycle({std::nan(""), 0, 0}), TwinError);
  CHECK_THROWS_AS(robot.cycle({0.5, 0, 0}), TwinError);
}

TEST_CASE("recordings are read back by calibration: commands per cycle, poses at the end of each") {
  const auto& walks = random_walks();
  const auto csv = diagnose_program::parse_csv(sequences_csv(walks), "twin.csv");
  calibrate_program::LoadOptions per_step;
  per_step.usual_steps = steps_per_cycle;
  const auto loaded = calibrate_program::sequences_of(csv, per_step);
  REQUIRE(loaded.sequences.size() == walks.size());
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const surefoot::WalkSequence expected = walk_sequence(walks[i]);
    CHECK((loaded.sequences[i].commands - expected.commands).cwiseAbs().maxCoeff() <= 1.01e-6);
    CHECK((loaded.sequences[i].poses - expected.poses).cwiseAbs().maxCoeff() <= 0.51e-6);
  }
  CHECK(sequences_csv({}) ==
        "seq,cycle,order_dx_m,order_dy_m,order_dtheta_rad,moved_x_m,moved_y_m,moved_theta_rad,x_m,y_m,theta_rad\n");
}

TEST_CASE("the same bits on one thread and on two; repeats differ by their noise alone") {
  const std::vector<Eigen::Matrix3Xd> same(3, surefoot::plan_commands(surefoot::CommandBounds(), 1, 4, 9).front());
  WalkingTwinOptions noisy;
  noisy.target_noise = 0.005;
  const auto one = record_sequences(noisy, same, 1, surefoot::Serial());
  const auto two = record_sequences(noisy, same, 1, surefoot::Threads(2));
  for (std::size_t i = 0; i < same.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) CHECK(one[i].moved[c].vec() == two[i].moved[c].vec());
  }
  CHECK(one[0].moved[3].vec() != one[1].moved[3].vec());
  const auto quiet = record_sequences({}, same, 1, surefoot::Threads(2));
  CHECK(quiet[0].moved[3].vec() == quiet[1].moved[3].vec());
}

TEST_CASE("the expert walks to a ball ahead until it may kick") {
  Approach::State start = Approach::State::Zero();
  start[0] = 0.6;
  WalkingTwin robot;
  const PlayedApproach played =
      play_approach(Approach::ha(), Winner2016(Winner2016Parameters::tuned()), robot, start, surefoot::Rng(1));
  CHECK(!played.fell);
  REQUIRE(played.kick);
  const Pose2 ball = played.cycle[static_cast<std::size_t>(*played.kick)].inverse() * played.ball;
  CHECK(Approach::ha().can_kick(ball.x, ball.y, ball.angle));
}

TEST_CASE("the interval of a share") {  // Wilson's interval of 9 in 10
  const Share share{9, 10};
  CHECK(share.low() == doctest::Approx(0.5958).epsilon(1e-3));
  CHECK(share.high() == doctest::Approx(0.9821).epsilon(1e-3));
  CHECK(Share{10, 10}.high() == doctest::Approx(1));
}

TEST_CASE("the program records, and says what it cannot do") {
  const approach_program::ScratchFolder folder;
  const std::string program = SUREFOOT_BIN_DIR "/surefoot-twin ";
  const auto recorded =
      approach_program::run_command(program + "record --sequences 2 --cycles 3 --seed 4 --out " + folder.file("a.csv"));
  CHECK(recorded.code == 0);
  const auto again = approach_program::run_command(program + "record --threads 1 --commands " + folder.file("a.csv") +
                                                   " --out " + folder.file("b.csv"));
  CHECK(again.code == 0);
  const auto csv = diagnose_program::read_csv(folder.file("b.csv"));
  CHECK(csv.rows() == 6);
  const auto refused = approach_program::run_command(program + "gains --switch wind");
  CHECK(refused.code == 2);
  CHECK(refused.output.find("there is no such switch") != std::string::npos);
}
