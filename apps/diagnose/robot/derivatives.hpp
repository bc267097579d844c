// Derivatives of a robot's errors by each property of each joint.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulate_robot.hpp"
#include "terms.hpp"

namespace diagnose_robot {

/// Derivatives of one joint's readings or torque; entries of joints that do not move it are not there.
struct JointDerivatives {
  std::vector<std::size_t> entries;
  Eigen::MatrixXd by;        // row x place in `entries`
  Eigen::MatrixXd by_start;  // of readings: row x (angles, then speeds at the start of joints that move each other)
};

/// Of the readings of simulate_robot(), by joint, with those by the start: exact derivatives of its steps (sticking
/// joints stay, the rest slips as it does), with inverse dynamics derived by differences once a row. NaN where the
/// simulation ran away. Cost: some 2 * joints of the largest tree + 5 for bodies simulations, for any number of
/// entries.
std::vector<JointDerivatives> simulation_derivatives(const Robot& robot, const RobotRecording& recording,
                                                     const StartState& start, const RobotPhysics& physics,
                                                     const std::vector<PhysicsEntry>& entries);

/// Of the torque that moves the rigid bodies along a motion, by bodies and by offsets of encoders; others are 0.
std::vector<JointDerivatives> rigid_derivatives(const Robot& robot, const Motion& motion, const RobotPhysics& physics,
                                                const std::vector<PhysicsEntry>& entries);

/// Of torque_residual(), by joint; `rigid`: those of rigid_derivatives().
std::vector<JointDerivatives> torque_derivatives(const Robot& robot, const Motion& motion, const RobotPhysics& physics,
                                                 const std::vector<PhysicsEntry>& entries,
                                                 const std::vector<JointDerivatives>& rigid);

}  // namespace diagnose_robot
