// Errors of a robot, of whole simulations or of torques, and how they change with each term.
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "linear_model.hpp"
#include "motion.hpp"
#include "robot.hpp"
#include "surefoot/core/executor.hpp"
#include "terms.hpp"

namespace diagnose_robot {

/// What the search has to explain.
struct Evidence {
  const Robot& robot;
  std::vector<RobotRecording> recordings;
  std::vector<Motion> motions;
  std::vector<int> block;  // by row of all recordings: contiguous parts that are held out one at a time
  int blocks = 0;
  std::vector<char> silent;  // by joint: its torque is not recorded, only its motion
  std::vector<JointScale> scales;
  std::vector<Term> terms;
  surefoot::Threads threads{1};
  std::stop_token stop;

  explicit Evidence(const Robot& r) : robot(r) {}
};

/// Blocks, scales and terms from recordings and motions.
void prepare(Evidence& evidence);

/// Errors of all recordings, one after the other: row x joint. Measured less simulated angle for position drives, the torque
/// that is left for torque drives. NaN: not known. Not finite in all of a column where a simulation ran away.
Eigen::MatrixXd errors_of(const Evidence& evidence, const RobotPhysics& physics);

/// `wanted`: terms whose derivatives are asked for; the others' are 0.
LinearModel linearize(const Evidence& evidence, const Eigen::VectorXd& theta, const Eigen::MatrixXd& errors, const TermSet& wanted);

/// Root mean square by joint, of the rows of a block (-1: all).
Eigen::VectorXd rms_by_joint(const Evidence& evidence, const Eigen::MatrixXd& errors, int block = -1);

}  // namespace diagnose_robot
