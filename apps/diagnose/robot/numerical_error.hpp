// How far two simulations of one and the same model are apart: ours, and MuJoCo's with the step of the file.
#pragma once

#include <filesystem>

#include "linearize.hpp"

namespace diagnose_robot {

/// Root mean square by joint, of the model as it stands; 0 where torques drive. What is smaller is no physics.
Eigen::VectorXd numerical_error(const Evidence& evidence, const std::filesystem::path& folder);

}  // namespace diagnose_robot
