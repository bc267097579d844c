// A model and a setup put together: the joints that are diagnosed, their groups, and which of them move each other.
#pragma once

#include <string>
#include <vector>

#include "joint_physics.hpp"
#include "robot_log.hpp"
#include "robot_model.hpp"
#include "setup.hpp"

namespace diagnose_robot {

struct RobotJoint {
  ModelJoint model;
  JointSetup setup;
  int group = 0;
  int before = -1;  // the joint nearer to the base that moves it, -1: none
  int tree = 0;     // joints of different trees do not move each other
};

struct Robot {
  RobotModel model;
  RobotSetup setup;
  std::vector<RobotJoint> joints;        // in the order of the setup
  std::vector<std::vector<int>> groups;  // joints of each group of the setup
  std::vector<int> joint_of_dof;         // -1: held
  RobotPhysics nominal;                  // damping, armature and frictionloss as the file has them
  int trees = 1;
};

/// Throws surefoot::DiagnoseError with one sentence where model and setup do not fit.
Robot bind_robot(RobotModel model, const RobotSetup& setup);

/// Throws if the recording shows what this diagnosis does not know: degrees, or contacts. Returns remarks.
std::vector<std::string> check_recording(const Robot& robot, const RobotRecording& recording);

/// The model with masses, centres of mass, payloads and springs changed, and with no damping, armature and friction of
/// its own.
ModelPointer model_with_bodies(const Robot& robot, const RobotPhysics& physics);

bool changes_bodies(const JointPhysics& joint);

/// [rad] or [m], the position of a joint at which its spring gives nothing.
double rest_of_spring(const Robot& robot, std::size_t joint);

}  // namespace diagnose_robot
