// Simulation of a whole robot over a recording, its joints driven to their goals.
//
// Semi-implicit steps: velocities that damp (of joints and drives) are implicit, as MuJoCo's `implicit` has them, dry friction
// of all joints sticks and slips together (coupled_dry_friction.hpp). Positions follow the new velocities. The error of a
// step is of first order: half a step of delay.
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
