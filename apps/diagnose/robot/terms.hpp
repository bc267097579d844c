// Terms of the search: a property at a joint, or one size of it tied over a group.
#pragma once

#include <Eigen/Core>
#include <cstddef>
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

/// A property of one joint, all of it: within the bounds of the property, whatever its group has.
Term term_of_joint(const PropertyInfo& info, std::size_t joint, const JointScale& scale);

/// A property of a joint, by which errors are derived.
struct PhysicsEntry {
  Property property{};
  int joint = 0;
};

/// All that terms are made of, each once.
std::vector<PhysicsEntry> entries_of(const std::vector<Term>& terms);

/// What the file states and the sums of terms, by joint, each property within what is possible.
RobotPhysics physics_of(const std::vector<Term>& terms, const Eigen::VectorXd& theta, const RobotPhysics& nominal);

/// Mean over the joints of the term of what the file states.
double nominal_of(const Robot& robot, const Term& term);

/// "hip", the name of the joint, or "all joints".
std::string place_of(const Robot& robot, const Term& term);

/// The unit at this joint, which may slide instead of turn.
std::string unit_of(const Robot& robot, const Term& term);

}  // namespace diagnose_robot
