// The torque limit that the measured motion shows: no simulation is needed to see where a drive gives less than it is
// told.
#pragma once

#include "linearize.hpp"

namespace diagnose_robot {

/// Limits [N m] of a position drive, the most likely first: those of the torques it was told at which what it gave is
/// nearest to what the motion needed. Empty where the drive was never told anything else than it could give.
std::vector<double> limits_along_motion(const Evidence& evidence, const RobotPhysics& physics, int joint);

}  // namespace diagnose_robot
