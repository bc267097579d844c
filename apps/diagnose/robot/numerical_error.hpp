// How far two simulations of one and the same model are apart: ours, and MuJoCo's with the step of the file; and two
// filters of one and the same motion.
#pragma once

#include "linearize.hpp"

namespace diagnose_robot {

/// Root mean square by joint, over all recordings, with these physics and starts; 0 where torques drive. What is
/// smaller is no physics. Cost: two simulations of each.
Eigen::VectorXd numerical_error(const Evidence& evidence, const RobotPhysics& physics,
                                const std::vector<StartState>& starts);

/// Root mean square by joint of what smoothing takes from torques along the motion, from the difference to a window
/// that is wider by the root of 2: what is taken goes with its fourth power.
Eigen::VectorXd smoothing_error(const Evidence& evidence, const RobotPhysics& physics);

/// What a numerical error may be is no more than what is left where physics is known: the share of
/// `evidence.numerical`, at most 1, that is left beyond the noise of sensors in the median of joints (of two: in the
/// worse one).
double numerical_share(const Evidence& evidence, const Eigen::MatrixXd& errors);

/// Lowers `evidence.numerical` to the share that recordings leave room for, if that is less by more than estimates of
/// it are off; returns that share, 1 where nothing changes.
double cap_numerical_error(Evidence& evidence, const Eigen::MatrixXd& errors);

/// Raises `evidence.numerical` to `share` of that with physics that were found, as far as the errors that these leave
/// at each joint have room for it: a joint whose drive is at its limit does not correct what simulations differ by.
/// False if it hardly changes.
bool raise_numerical_error(Evidence& evidence, const RobotPhysics& physics, const std::vector<StartState>& starts,
                           const Eigen::MatrixXd& errors, double share);

/// Lowers `evidence.numerical` to that, and to a half where errors are beyond it and noise all the same: it is no
/// excuse then for leaving them unexplained. False if it hardly changes.
bool lower_numerical_error(Evidence& evidence, const Eigen::MatrixXd& errors);

}  // namespace diagnose_robot
