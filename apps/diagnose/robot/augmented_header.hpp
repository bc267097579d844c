// What was found and MJCF cannot say (delays, lags, backlash, friction that depends on load) as a C++ header.
#pragma once

#include <string>

#include "robot.hpp"

namespace diagnose_robot {

std::string augmented_header(const Robot& robot, const RobotPhysics& physics);

}  // namespace diagnose_robot
