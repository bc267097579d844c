// Robots of two joints for tests, and files of them.
#pragma once

#include <string>

#include "apps/diagnose/robot/linearize.hpp"
#include "apps/diagnose/robot/robot.hpp"
#include "apps/diagnose/robot/setup.hpp"
#include "benchmarks/blind/robots/robot_case.hpp"
#include "tests/support/program.hpp"

namespace robot_test {

using approach_program::ScratchFolder;
using approach_program::write_text;

/// An arm of two joints under position drives, without anything hidden.
inline blind_robots::RobotCase small_arm() {
  blind_robots::RobotCase arm;
  arm.family = "arm2";
  for (const std::string name : {"upper", "lower"}) {
    blind_robots::Joint joint;
    joint.name = name;
    joint.group = name;
    joint.parent = name == "lower" ? "upper" : "";
    joint.length = 0.25;
    joint.mass = name == "lower" ? 0.8 : 1.5;
    joint.kp = name == "lower" ? 30 : 150;
    joint.kd = name == "lower" ? 0.8 : 6;
    joint.limit = 50;
    arm.joints.push_back(joint);
  }
  arm.truth = nlohmann::ordered_json::array();
  return arm;
}

/// Model, setup and recordings in the folder.
inline void write_files(const ScratchFolder& folder, const blind_robots::RobotCase& arm, std::uint64_t seed,
                        int recordings = 2) {
  plants::Random random(seed);
  write_text(folder.file("robot.xml"), blind_robots::robot_xml(arm, false));
  write_text(folder.file("robot.toml"), blind_robots::robot_setup(arm));
  for (int r = 1; r <= recordings; ++r)
    write_text(folder.file("rec_" + std::to_string(r) + ".csv"), blind_robots::record(arm, random));
}

inline diagnose_robot::Robot load(const ScratchFolder& folder) {
  return diagnose_robot::bind_robot(diagnose_robot::load_robot(folder.file("robot.xml")),
                                    diagnose_robot::read_setup(folder.file("robot.toml")));
}

/// The small arm with files in the folder, whose upper drive is said to give this torque at most [N m].
inline diagnose_robot::Robot arm_with_limit(const ScratchFolder& folder, double limit) {
  auto arm = small_arm();
  arm.joints[0].limit = limit;
  write_files(folder, arm, 32);
  return load(folder);
}

inline void add_recording(diagnose_robot::Evidence& evidence, const std::string& file) {
  evidence.recordings.push_back(
      diagnose_robot::read_recording(diagnose_program::read_csv(file), evidence.robot.setup, 100000));
  evidence.motions.push_back(diagnose_robot::smooth(evidence.recordings.back()));
}

}  // namespace robot_test
