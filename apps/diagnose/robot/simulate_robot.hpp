// Simulation of a whole robot over a recording, its joints driven to their goals.
//
// Steps of second order: half a step of position, a step of velocity with the forces of mid-step, the other half.
// Damping (of joints and drives) is implicit, dry friction of all joints sticks and slips together
// (coupled_dry_friction.hpp); a step is divided where a joint comes to rest and its friction turns.
#pragma once

#include <Eigen/Core>

#include "motion.hpp"
#include "robot.hpp"

namespace diagnose_robot {

/// [s], a whole part of the rows' period.
double simulation_step(const Robot& robot, const RobotRecording& recording);

struct StartState {
  Eigen::VectorXd angle, speed;
};

StartState start_of(const Motion& motion);

/// The readings that the robot would give: row x joint. Not finite where the motion has run away.
Eigen::MatrixXd simulate_robot(const Robot& robot, const RobotRecording& recording, const StartState& start,
                               const RobotPhysics& physics);

}  // namespace diagnose_robot
