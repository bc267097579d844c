// Angles that never change in a recording while the model of their joint moves.
#pragma once

#include <string>

#include "linearize.hpp"

namespace diagnose_robot {

/// A sentence with the cure for the first such column of the evidence's recording; empty: none. Position drives only:
/// torques alone do not say where a joint goes. Cost: a simulation where a column never changes, otherwise nothing.
std::string stuck_sensor(const Evidence& evidence, std::size_t recording);

}  // namespace diagnose_robot
