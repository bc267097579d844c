// surefoot-diagnose with robots, from files to files.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/diagnose/robot/stuck_sensor.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using approach_program::Outcome;
using nlohmann::json;
using robot_test::ScratchFolder;

namespace {

std::string program() { return SUREFOOT_BIN_DIR "/surefoot-diagnose"; }

Outcome diagnose(const ScratchFolder& folder, const std::string& more = "") {
  return approach_program::run_command(program() + " --model " + folder.file("robot.xml") + " --setup " +
                                       folder.file("robot.toml") + " --out " + folder.file("out") + " --quiet " + more +
                                       " " + folder.file("rec_1.csv") + " " + folder.file("rec_2.csv"));
}

std::string recordings() {
  const char* folder = std::getenv("SUREFOOT_RECORDINGS");
  return folder == nullptr ? "" : folder;
}

json result_of(const ScratchFolder& folder) {
  std::ifstream file(folder.file("out/diagnosis.json"));
  return json::parse(file);
}

}  // namespace

TEST_CASE("dry friction in one joint of an arm is found with its size, and nothing else") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.joints[0].hidden.coulomb = 0.6;
  robot_test::write_files(folder, arm, 11);
  const Outcome outcome = diagnose(folder);
  CAPTURE(outcome.output);
  REQUIRE(outcome.code == 0);
  const json result = result_of(folder);
  REQUIRE(result["effects"].size() == 1);
  CHECK(result["effects"][0]["name"] == "coulomb_friction");
  CHECK(result["effects"][0]["attached_to"] == "upper");
  CHECK(double(result["effects"][0]["parameters"][0]["value"]) == doctest::Approx(0.6).epsilon(0.05));
  CHECK(double(result["robot"]["rmse_replayed"]) ==
        doctest::Approx(double(result["robot"]["rmse_after"])).epsilon(0.02));
  REQUIRE(result["robot"]["not_named"].size() == 5);  // of each joint: dry, viscous, inertia, but for what was found
  for (const json& other : result["robot"]["not_named"]) {
    const double stated = other["effect"] == "rotor_inertia" ? blind_robots::file_armature : 0;
    CHECK(std::abs(double(other["value"]) - stated) < 3 * double(other["stderr"]));
  }
  for (const char* file : {"report.html", "augmented.xml", "augmented.hpp"})
    CHECK(std::filesystem::file_size(folder.file(std::string("out/") + file)) > 100);
}

TEST_CASE("fast drives are replayed to the stated error, with steps that are short enough") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  for (auto& joint : arm.joints) {
    joint.kp *= 8;
    joint.kd *= 8;
    joint.limit *= 8;
  }
  robot_test::write_files(folder, arm, 11);
  const Outcome outcome = diagnose(folder);
  CAPTURE(outcome.output);
  REQUIRE(outcome.code == 0);
  const json result = result_of(folder);
  CHECK(double(result["robot"]["rmse_replayed"]) ==
        doctest::Approx(double(result["robot"]["rmse_after"])).epsilon(0.02));
}

TEST_CASE("an arm that is as its model says gets no effect") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 12);
  REQUIRE(diagnose(folder).code == 0);
  const json result = result_of(folder);
  CHECK(result["effects"].empty());
  CHECK(result["verdict"] == "adequate");
}

TEST_CASE("the inertia of a rotor is found, and said to be like that of its link") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.torque_driven = true;
  arm.joints[0].hidden.armature = 0.1;
  robot_test::write_files(folder, arm, 16);
  std::string setup = blind_robots::robot_setup(arm);
  const std::string bodies = ", \"bodies\"";
  setup.erase(setup.find(bodies), bodies.size());
  robot_test::write_text(folder.file("robot.toml"), setup);
  REQUIRE(diagnose(folder).code == 0);
  const json result = result_of(folder);
  bool found = false, tied = false;
  for (const json& effect : result["effects"])
    found = found || (effect["name"] == "rotor_inertia" && effect["attached_to"] == "upper");
  for (const json& other : result["alternatives"]) tied = tied || other["effects"][0]["name"] == "link_inertia";
  CHECK(found);
  CHECK(tied);
}

TEST_CASE("what no recording could show of an arm on a vertical axis is said to be invisible, and what shows is not") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.torque_driven = true;
  arm.joints[0].axis = 'z';
  arm.joints[0].hidden.bias = 0.1;
  robot_test::write_files(folder, arm, 19);
  REQUIRE(diagnose(folder).code == 0);
  const json result = result_of(folder);
  CHECK(result["effects"].empty());
  bool upper = false;
  for (const json& one : result["robot"]["invisible"]) {
    upper = upper || (one["effect"] == "sensor_bias" && one["joint"] == "upper");
    CHECK(one["joint"] != "lower");
  }
  CHECK(upper);
}

TEST_CASE("a sensor that is stuck while the model moves is refused in one sentence, a joint that stands still is not") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  robot_test::write_files(folder, arm, 23, 1);
  const diagnose_robot::Robot robot = robot_test::load(folder);
  diagnose_robot::Evidence evidence(robot);
  robot_test::add_recording(evidence, folder.file("rec_1.csv"));
  CHECK(diagnose_robot::stuck_sensor(evidence, 0).empty());
  evidence.recordings[0].angle.col(1).setConstant(0.25);
  evidence.motions[0] = diagnose_robot::smooth(evidence.recordings[0]);
  const std::string sentence = diagnose_robot::stuck_sensor(evidence, 0);
  CHECK(sentence.find("'lower_rad' is stuck at 0.25 rad, while the model moves by") != std::string::npos);
  CHECK(sentence.find("list 'lower' under held") != std::string::npos);
  evidence.recordings[0].goal.setZero();
  evidence.recordings[0].angle.setZero();
  evidence.motions[0] = diagnose_robot::smooth(evidence.recordings[0]);
  CHECK(diagnose_robot::stuck_sensor(evidence, 0).empty());  // hangs, and is told to
}

TEST_CASE("the same seed gives the same result for any number of threads") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.joints[1].hidden.viscous = 0.4;
  robot_test::write_files(folder, arm, 13);
  REQUIRE(diagnose(folder, "--threads 1").code == 0);
  json one = result_of(folder);
  REQUIRE(diagnose(folder, "--threads 3").code == 0);
  json three = result_of(folder);
  one.erase("seconds");
  three.erase("seconds");
  CHECK(one == three);
}

TEST_CASE("swapped columns are named, and repaired if asked for") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.swapped = {{0, 1}};
  robot_test::write_files(folder, arm, 14);
  REQUIRE(diagnose(folder).code == 0);
  CHECK(result_of(folder)["log_faults"][0]["kind"] == "columns_swapped");
  CHECK(result_of(folder)["verdict"] == "unexplained");
}

TEST_CASE("swapped columns of an arm that torques drive are named, though each torque is partly explained as it is") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.torque_driven = true;
  arm.swapped = {{0, 1}};
  robot_test::write_files(folder, arm, 18);
  REQUIRE(diagnose(folder).code == 0);
  const json result = result_of(folder);
  REQUIRE(result["log_faults"].size() == 1);
  CHECK(result["log_faults"][0]["kind"] == "columns_swapped");
}

TEST_CASE("a recorded torque on another scale is found at its joint, and nothing else") {
  const ScratchFolder folder;
  auto arm = robot_test::small_arm();
  arm.torque_driven = true;
  arm.joints[1].hidden.weakness = 0.48;
  robot_test::write_files(folder, arm, 17);
  REQUIRE(diagnose(folder).code == 0);
  const json result = result_of(folder);
  REQUIRE(result["effects"].size() == 1);
  CHECK(result["effects"][0]["name"] == "sensor_scale");
  CHECK(result["effects"][0]["attached_to"] == "lower");
  CHECK(double(result["effects"][0]["parameters"][0]["value"]) == doctest::Approx(1 / 0.52 - 1).epsilon(0.03));
  CHECK(result["verdict"] == "parameters-only");
}

TEST_CASE("a setup is printed that the diagnosis can use") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 15);
  const Outcome setup = approach_program::run_command(program() + " setup " + folder.file("robot.xml") + " " +
                                                      folder.file("rec_1.csv") + " > " + folder.file("first.toml"));
  CHECK(setup.code == 0);
  std::ifstream file(folder.file("first.toml"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  CHECK(text.find("goal = \"goal_upper_rad\"") != std::string::npos);
  CHECK(text.find("SET kp") != std::string::npos);
}

// The whole recording, since half of it does not tell friction in calves from that in the other joints: ten seconds.
TEST_CASE("legs of a real quadruped: few effects, and better than the best fit of one size by class" *
          doctest::skip(recordings().empty())) {
  const ScratchFolder folder;
  const std::string legs = recordings() + "/go2_legs/";
  approach_program::run_command(program() + " setup " + legs + "go2.xml " + legs + "first.csv > " +
                                folder.file("robot.toml"));
  const Outcome outcome =
      approach_program::run_command(program() + " --model " + legs + "go2.xml --setup " + folder.file("robot.toml") +
                                    " --quiet --out " + folder.file("out") + " " + legs + "first.csv");
  CAPTURE(outcome.output);
  REQUIRE(outcome.code == 0);
  const json result = result_of(folder);
  CHECK(double(result["robot"]["rmse_heldout"]) < 0.0100);
  CHECK(result["effects"].size() <= 8);
  for (const json& effect : result["effects"]) CHECK(effect["name"] != "input_delay");  // it looks good, and is wrong
  CHECK(double(result["robot"]["rmse_replayed"]) ==
        doctest::Approx(double(result["robot"]["rmse_after"])).epsilon(0.02));
}
