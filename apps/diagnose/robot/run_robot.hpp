// A diagnosis of a whole robot, from the command line to the files.
#pragma once

#include <filesystem>
#include <string>

#include "../command_line.hpp"

namespace diagnose_robot {

/// Whether `--model` names a robot (MJCF or URDF) rather than equations.
inline bool is_robot_model(const std::filesystem::path& model) {
  const std::string ending = model.extension().string();
  return ending == ".xml" || ending == ".urdf" || ending == ".mjcf";
}

int run_robot(const diagnose_program::CommandLine& line);

/// `surefoot-diagnose setup robot.xml log.csv`: prints a first setup.
int run_setup(int argc, const char* const* argv);

}  // namespace diagnose_robot
