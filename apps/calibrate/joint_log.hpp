// Logs of the joints of a walk: what they were told, where they were, what current they drew.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace calibrate_program {

/// One joint through a few seconds of walking, in time steps that may vary.
struct JointBlock {
  std::vector<double> time, goal, angle, current;  // [s, rad, rad, A]; no current where none was logged
};

/// Blocks by joint, in their order in the file.
struct JointLog {
  std::vector<std::string> joints;
  std::vector<std::vector<JointBlock>> blocks;
};

/// Of files with the columns t_s, goal_NAME_rad and position_NAME_rad, as surefoot-walk and `surefoot-twin record
/// --joints` write them, current_NAME_A where there is one, and enabled_1, 0 where the robot stood. Where time goes
/// back a new sequence begins. Throws UsageError for a file without these columns or without a block that is long
/// enough.
JointLog read_joint_logs(const std::vector<std::filesystem::path>& files);

}  // namespace calibrate_program
