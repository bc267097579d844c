// Errors of a robot, of whole simulations or of torques, and how they change with each term.
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <vector>

#include "derivatives.hpp"
#include "linear_model.hpp"
#include "motion.hpp"
#include "robot.hpp"
#include "surefoot/core/executor.hpp"
#include "terms.hpp"

namespace diagnose_robot {

/// What the search has to explain.
struct Evidence {
  const Robot& robot;
  std::filesystem::path folder;  // of the model file
  std::vector<RobotRecording> recordings;
  std::vector<Motion> motions;
  std::vector<StartState> starts;  // by recording: where simulations begin
  std::vector<int> block;  // by row of all recordings: contiguous parts that are held out one at a time
  int blocks = 0;
  std::vector<char> silent;   // by joint: its torque is not recorded, only its motion
  Eigen::VectorXd numerical;  // by joint: errors of simulation, see numerical_error(); empty: none
  std::vector<JointScale> scales;
  std::vector<Term> terms;
  std::vector<PhysicsEntry> entries;  // all properties of single joints that terms are made of
  RobotPhysics base;                  // that terms add to
  surefoot::Threads threads{1};
  std::stop_token stop;

  explicit Evidence(const Robot& r) : robot(r), base(r.nominal) {}
};

/// Blocks, starts, scales and terms from recordings and motions.
void prepare(Evidence& evidence);

/// Errors of all recordings, one after the other: row x joint. Measured less simulated angle for position drives, the
/// torque that is left for torque drives. NaN: not known. Not finite in all of a column where a simulation ran away.
/// Simulations begin at `starts`, or at those of the evidence.
Eigen::MatrixXd errors_of(const Evidence& evidence, const RobotPhysics& physics, const std::vector<StartState>& starts);
Eigen::MatrixXd errors_of(const Evidence& evidence, const RobotPhysics& physics);

/// Sets errors of a simulation to NaN while it still depends on how it began.
void leave_out_start(const Robot& robot, const RobotRecording& recording, Eigen::Ref<Eigen::MatrixXd> errors);

/// Derivatives of the rigid bodies' torque along the recordings, which stay as long as bodies and encoders do.
struct RigidCache {
  RobotPhysics physics;
  std::vector<std::vector<JointDerivatives>> by_recording;
};

/// Sums at `theta` and `starts`, where `errors` are those of all rows, for all terms; starts follow them, see starts.hpp.
LinearModel linearize(const Evidence& evidence, const Eigen::VectorXd& theta, const std::vector<StartState>& starts,
                      const Eigen::MatrixXd& errors, RigidCache& cache);

/// Root mean square by joint, of the rows of a block (-1: all).
Eigen::VectorXd rms_by_joint(const Evidence& evidence, const Eigen::MatrixXd& errors, int block = -1);

}  // namespace diagnose_robot
