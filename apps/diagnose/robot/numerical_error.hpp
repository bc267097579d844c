// How far a simulation is from what its model says.
#pragma once

#include "linearize.hpp"

namespace diagnose_robot {

/// Root mean square by joint of what steps of no length would change (Richardson), of the model as it stands; 0 where
/// torques drive. What is smaller is no physics.
Eigen::VectorXd numerical_error(const Evidence& evidence);

}  // namespace diagnose_robot
