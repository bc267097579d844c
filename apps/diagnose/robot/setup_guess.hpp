// A first setup from a model and a log: columns matched to joints by name, groups from default classes and left/right
// symmetry, units guessed and said.
#pragma once

#include <string>
#include <vector>

#include "../csv.hpp"
#include "robot_model.hpp"
#include "setup.hpp"

namespace diagnose_robot {

struct SetupGuess {
  RobotSetup setup;
  std::vector<std::string> remarks;  // what was guessed and what to look at
};

/// Throws surefoot::DiagnoseError if no column fits any joint.
SetupGuess guess_setup(const RobotModel& model, const diagnose_program::Csv& csv);

/// Parts of a name: letters and digits that stand together, in small letters: "FL_hip_joint" gives fl, hip, joint.
std::vector<std::string> name_parts(const std::string& name);

/// Equal for joints that mirror each other or repeat along the body: name parts without left, right, front, rear.
std::string without_side(const std::string& joint);

}  // namespace diagnose_robot
