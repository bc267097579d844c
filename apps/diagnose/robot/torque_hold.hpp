// Recorded torques are readings of their moment, or commands of a controller that stand until its next one.
#pragma once

#include "linearize.hpp"

namespace diagnose_robot {

/// -2 log of the odds that torques stand until the next row, and so act half a row later than they are logged, against
/// readings that are used as they are; by what all groups may have, fitted together, leaves either way. 0 where
/// positions drive.
double evidence_for_held_torques(const Evidence& evidence);

/// Lets torques act half a row late where that is 20 times as probable. True if they do.
bool hold_torques(Evidence& evidence);

}  // namespace diagnose_robot
