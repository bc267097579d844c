// Torque along the measured motion that neither the rigid bodies nor the physics of the joints account for.
#pragma once

#include "motion.hpp"
#include "robot.hpp"

namespace diagnose_robot {

/// Row x joint [N m or N]. NaN where a joint is too slow for its friction to be known.
Eigen::MatrixXd torque_residual(const Robot& robot, const Motion& motion, const RobotPhysics& physics);

/// What the drive gives for each unit of the torque that is needed beside friction by load, which is a share of what
/// the drive gives and so of itself: 1 / (1 - share) where `torque` drives the joint, 1 / (1 + share) where it brakes.
double load_factor(const JointPhysics& physics, double speed, double torque);

/// What the rigid bodies need along the motion [N m].
Eigen::MatrixXd rigid_body_torque(const Robot& robot, const Motion& motion, const RobotPhysics& physics);

/// What the drives give along the motion: measured, or what position drives would give [N m].
Eigen::MatrixXd drive_torque(const Robot& robot, const Motion& motion);

/// The same where torques drive and arrive late. NaN before the first of them has arrived.
Eigen::MatrixXd arrived_torque(const Robot& robot, const Motion& motion, const RobotPhysics& physics);

/// Speeds below which a joint may stick, by joint.
Eigen::VectorXd resting_speed(const Motion& motion);

}  // namespace diagnose_robot
