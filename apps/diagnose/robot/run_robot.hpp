// A diagnosis of a whole robot, from the command line to the files.
#pragma once

#include "../command_line.hpp"

namespace diagnose_robot {

/// Whether `--model` names a robot (MJCF or URDF) rather than equations.
bool is_robot_model(const std::filesystem::path& model);

int run_robot(const diagnose_program::CommandLine& line);

/// `surefoot-diagnose setup robot.xml log.csv`: prints a first setup.
int run_setup(int argc, const char* const* argv);

}  // namespace diagnose_robot
