// One step of the simulation of a robot, and what its derivatives need to know of it.
#pragma once

#include <vector>

#include "simulate_robot.hpp"
#include "surefoot/optimize/coupled_dry_friction.hpp"

namespace diagnose_robot {

/// Torque of a drive: constant - damping * speed - inertia * acceleration. Readings that are old by a short time tau
/// are those of now less tau times their rate: damping kd - kp tau, inertia -kd tau.
struct DriveTorque {
  double goal = 0, constant = 0, damping = 0, inertia = 0;
  double stiffness = 0, told_damping = 0;  // of what it is told, also at its limit
  double limit = 0;                        // [N m]; 0: none
  double told = 0;         // before limit and lag, at the speed of mid-step
  bool saturated = false;  // at its limit: what it is told does not matter
};

/// Joints that move each other; those of different trees share nothing but time.
struct StepTree {
  std::vector<int> joints;
  Eigen::MatrixXd mass;
  Eigen::VectorXd momentum, friction, speed;
  surefoot::CoupledDryFriction work;
};

/// The robot between two steps, and the last step's inside.
struct RobotStep {
  const Robot& robot;
  const RobotRecording& recording;
  const RobotPhysics& physics;
  ModelPointer model;
  DataPointer data;
  Eigen::MatrixXd mass;                  // with what is implicit in it, after a step
  Eigen::VectorXd q, v, before, middle;  // before: speed a step ago; middle: in mid-step
  Eigen::VectorXd momentum, friction, seen, lagging;
  Eigen::VectorXd dissipation, implicit;  // of the step: damping of joint and drive, and its implicit share
  std::vector<DriveTorque> drives;        // of the step
  std::vector<StepTree> trees;

  RobotStep(const Robot& robot, const RobotRecording& recording, const StartState& start, const RobotPhysics& physics);

  const JointPhysics& joint(Eigen::Index i) const { return physics[static_cast<std::size_t>(i)]; }

  int stopped = -1;  // joint that the last substep ended for; -1: none

  /// From time t, which is in this row, by h.
  void step(Eigen::Index row, double t, double h);

  /// The same, but only until a joint with dry friction comes to rest, where its friction turns, or until a torque
  /// reaches its limit or leaves it: with one law for all of a step, each of these would cost the second order. Returns
  /// the time that has passed, `stopped` says which joint came to rest.
  double substep(Eigen::Index row, double t, double h);

  /// What sensors say now.
  void read(Eigen::MatrixXd& readings, Eigen::Index row) const;

  bool ran_away() const;

 private:
  struct State {
    Eigen::VectorXd q, v, before, seen, lagging;
    double passed = 0;
  };
  Eigen::VectorXd next_;
  State start_;
  double passed_ = 0;  // [s], length of the last substep, from `before` to `v`

  State state() const { return {q, v, before, seen, lagging, passed_}; }
  void restore(const State& state);
  void advance(Eigen::Index row, double t, double h);
  double share_until_rest();
  double told_at(Eigen::Index i, double angle, double speed) const;
  double share_until_limit() const;
  void solve_friction();

  void rigid_bodies();
  DriveTorque drive(Eigen::Index i, Eigen::Index row, double t, double h);
};

/// Mean of the goal, held between rows, from `from` to `from + length`; smooth in `from`, so that delays can be fitted.
double mean_goal(const RobotRecording& recording, Eigen::Index joint, Eigen::Index row, double from, double length);

/// What a torque that lags takes over of what is told, in one step: then it follows a ramp later by `lag` [s], for any
/// step. (1 - exp(-step / lag) would be half a step too early, and drop lags below a step.)
double lag_share(double step, double lag);

/// The speed below which friction falls from breakaway: exp(-(v / stribeck_speed)^2).
double stribeck_share(double speed);

}  // namespace diagnose_robot
