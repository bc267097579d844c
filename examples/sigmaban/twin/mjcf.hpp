// The twin in MuJoCo's language.
#pragma once

#include <string>

#include "twin_parameters.hpp"
#include "twin_switches.hpp"

namespace sigmaban {

/// The model as MJCF. Bodies: trunk, and for each side hip_yaw, hip_block, thigh, shin, ankle_block, foot; joints and
/// actuators by joint_names, with backlash further joints named NAME_play; geoms of the cleats: left_cleat_1, ...
/// The ground is the plane z = 0; a slope is gravity that leans.
std::string mjcf(const TwinParameters& parameters, const TwinSwitches& switches);

}  // namespace sigmaban
