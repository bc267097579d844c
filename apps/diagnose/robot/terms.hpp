// Terms of the search: a property at a joint, or one size of it tied over a group.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "robot.hpp"

namespace diagnose_robot {

inline constexpr int single_joint = -1, all_joints = -2;

struct Term {
  Property property{};
  std::vector<int> joints;
  int group =
      single_joint;  // of the setup; single: a joint of its own, beyond what its group has; all: every joint alike
  double typical = 1, low = 0, high = 0;
};

/// Groups first, then what all joints may have alike, then single joints.
std::vector<Term> all_terms(const Robot& robot, const std::vector<JointScale>& scales);

/// Sums of terms by joint, each property within what is possible.
RobotPhysics physics_of(const std::vector<Term>& terms, const Eigen::VectorXd& theta, std::size_t joints);

/// Sizes of the group terms that come nearest to what the joints have, and the rest in the terms of single joints.
Eigen::VectorXd theta_of(const std::vector<Term>& terms, const RobotPhysics& physics);

/// "hip", the name of the joint, or "all joints".
std::string place_of(const Robot& robot, const Term& term);

/// The unit at this joint, which may slide instead of turn.
std::string unit_of(const Robot& robot, const Term& term);

}  // namespace diagnose_robot
