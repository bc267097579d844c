#include "apps/diagnose/robot/setup.hpp"

#include <doctest/doctest.h>

#include <string>

#include "apps/diagnose/robot/setup_guess.hpp"
#include "apps/diagnose/robot/xml_text.hpp"
#include "surefoot/core/error.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;

namespace {

const std::string good = R"(schema = "surefoot.robot/1"
[drive]
kp = 20
[groups]
legs = ["a", "b"]
[joints.a]
goal = "goal_a_deg"
angle = { column = "angle_a", unit = "deg" }
[joints.b]
goal = "goal_b_rad"
angle = "b_rad"
kp = 5
)";

std::string refusal(const std::string& text) {
  try {
    parse_setup(text, "robot.toml");
  } catch (const surefoot::DiagnoseError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("a setup of a robot is read with its units") {
  const RobotSetup setup = parse_setup(good, "robot.toml");
  CHECK(setup.drive == DriveKind::position);
  CHECK(setup.joints.at(0).goal.factor == doctest::Approx(0.0174533));
  CHECK(setup.joints.at(0).angle.factor == doctest::Approx(0.0174533));
  CHECK(setup.joints.at(1).angle.factor == 1);
  CHECK(setup.joints.at(0).kp == 20);
  CHECK(setup.joints.at(1).kp == 5);
  CHECK(setup.groups.at(0).joints.size() == 2);
}

TEST_CASE("a setup nested deeper than its reader's stack, or that is no UTF-8, is refused") {
  const std::string nested = "a = " + std::string(300'000, '[') + std::string(300'000, ']');
  CHECK(refusal(nested).find("robot.toml, line 1: more than 100 brackets are open") == 0);
  CHECK(refusal("time = 't'\nname = '\260'\n").find("robot.toml, line 2: a byte that is no UTF-8") == 0);
}

TEST_CASE("what is wrong in a setup is said in one sentence with its place") {
  CHECK(refusal(replaced(good, "surefoot.robot/1", "other")).find("schema") != std::string::npos);
  CHECK(refusal(replaced(good, "kp = 20", "kpp = 20")).find("did you mean 'kp'") != std::string::npos);
  CHECK(refusal(replaced(good, "goal = \"goal_b_rad\"", "")).find("goal") != std::string::npos);
  CHECK(refusal(replaced(good, "\"b\"]", "\"c\"]")).find("'c'") != std::string::npos);
  CHECK(refusal(replaced(good, "unit = \"deg\"", "unit = \"grad\"")).find("'grad'") != std::string::npos);
  CHECK(refusal(replaced(good, "kp = 5", "kp = \"much\"")).find("a finite number") != std::string::npos);
  CHECK(refusal("[joints").find("not valid TOML") != std::string::npos);
}

TEST_CASE("a setup that is written is read as it was") {
  const RobotSetup setup = parse_setup(good, "robot.toml");
  const RobotSetup again = parse_setup(setup_text(setup, {"a remark"}), "robot.toml");
  CHECK(again.joints.at(0).angle.factor == doctest::Approx(setup.joints.at(0).angle.factor));
  CHECK(again.joints.at(1).kp == 5);
  CHECK(again.groups.at(0).name == "legs");
}

TEST_CASE("columns, groups and units are guessed from names and readings") {
  const robot_test::ScratchFolder folder;
  robot_test::write_text(folder.file("legs.xml"),
                         R"(<mujoco><worldbody><body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <joint name="FL_hip_joint" limited="true" range="-60 60"/></body><body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <joint name="FR_hip_joint"/></body><body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="head"/></body>
    </worldbody></mujoco>)");
  const auto csv = diagnose_program::parse_csv(
      "# kp: 12\ntime,FL_hip_target,FR_hip_target,FL_hip,FR_hip,battery_V\n0,30,0.1,29,0.1,7\n0.01,-55,0.2,-54,0.1,7\n",
      "log.csv");
  const SetupGuess guess = guess_setup(load_robot(folder.file("legs.xml")), csv);
  CHECK(guess.setup.time == "time");
  REQUIRE(guess.setup.joints.size() == 2);
  CHECK(guess.setup.joints[0].goal.name == "FL_hip_target");
  CHECK(guess.setup.joints[0].angle.name == "FL_hip");
  CHECK(guess.setup.joints[0].angle.factor == doctest::Approx(0.0174533));
  CHECK(guess.setup.joints[1].angle.factor == doctest::Approx(0.0174533));  // a log has one unit
  CHECK(guess.setup.joints[0].kp == 12);
  CHECK(guess.setup.held == std::vector<std::string>{"head"});
  REQUIRE(guess.setup.groups.size() == 1);
  CHECK(guess.setup.groups[0].name == "hip");
  CHECK(parse_setup(setup_text(guess.setup, guess.remarks), "robot.toml").joints.size() == 2);
}

TEST_CASE("a setup cannot be guessed of a log that lacks one goal, and says which") {
  const robot_test::ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 3, 0);
  const auto csv =
      diagnose_program::parse_csv("t_s,goal_upper_rad,upper_rad,lower_rad\n0,0,0,0\n0.01,0,0,0\n", "log.csv");
  try {
    guess_setup(load_robot(folder.file("robot.xml")), csv);
    FAIL("guessed");
  } catch (const surefoot::DiagnoseError& error) {
    CHECK(std::string(error.what()).find("no column of a goal for lower; add it, named like goal_lower_rad") !=
          std::string::npos);
  }
}

TEST_CASE(
    "columns named radians that go far beyond the range are asked about, and ball joints said to be none of ours") {
  const robot_test::ScratchFolder folder;
  robot_test::write_text(folder.file("robot.xml"),
                         R"(<mujoco><worldbody><body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <joint name="hip" limited="true" range="-60 60"/><body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <joint name="ankle" type="ball"/></body></body></worldbody></mujoco>)");
  const auto csv = diagnose_program::parse_csv("t_s,goal_hip_rad,hip_rad\n0,30,29\n0.01,-55,-54\n", "log.csv");
  std::string remarks;
  for (const std::string& remark : guess_setup(load_robot(folder.file("robot.xml")), csv).remarks)
    remarks += remark + '\n';
  CAPTURE(remarks);
  CHECK(remarks.find("SET the unit") != std::string::npos);
  CHECK(remarks.find("ball joint ankle") != std::string::npos);
}

TEST_CASE("elements are taken out of an XML text with what is in them, but not in comments") {
  CHECK(without_elements("<a><b x=\"1\"><c/></b><!-- <b/> --><b/></a>", {"b"}) == "<a><!-- <b/> --></a>");
  CHECK(without_meshes("<m><mesh file=\"x.stl\"/><geom type=\"mesh\" mesh=\"x\"/><geom size=\"1\"/></m>") ==
        "<m><geom size=\"1\"/></m>");
  CHECK(attribute("<joint class='hip' name=\"a\"/>", "class") == "hip");
  CHECK(without_side("LEFT_knee_joint") == "knee");
  CHECK(without_side("joint_1") == "joint_1");
}
