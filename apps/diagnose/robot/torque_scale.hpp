// Recorded torques that are no torques of the joint: currents, torques of the motor before its gear, the other sign.
#pragma once

#include <vector>

#include "linearize.hpp"

namespace diagnose_robot {

struct ScaleCriteria {
  double factor = 3;  // between what is recorded and what moves the bodies: no mass and no motor is off by so much
};

/// Joints whose torque, with what all groups may have beside it, is on another scale than the model's, by more than
/// that or of the other sign, at odds of 20. None where positions drive or scales are calibrated. Cost: one
/// linearization.
std::vector<int> joints_of_other_scale(const Evidence& evidence, const ScaleCriteria& criteria = {});

}  // namespace diagnose_robot
