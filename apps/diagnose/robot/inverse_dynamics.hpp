// Torques that move the rigid bodies of a robot, and how they change with its motion and its bodies.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "derivatives.hpp"

namespace diagnose_robot {

/// Joints of the setup that move each other.
std::vector<std::vector<int>> joints_by_tree(const Robot& robot);

/// Inverse dynamics with springs, by joint, without armature and friction.
void rigid_body_torque(const Robot& robot, const mjModel* m, mjData* d, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& v, const Eigen::VectorXd& a, Eigen::VectorXd& torque);

/// Derivatives by differences; the same place in all trees at once. Cost: 2 * joints of the largest tree evaluations,
/// and one for each property of bodies and place among the entries.
class InverseDynamics {
 public:
  struct Tree {
    std::vector<int> joints;
    std::vector<std::size_t> entries;
    Eigen::MatrixXd by_angle, by_speed;  // place x place
    Eigen::MatrixXd by_entry;            // place x entry of bodies; 0 for others
  };
  std::vector<Tree> trees;

  InverseDynamics(const Robot& robot, const RobotPhysics& physics, const std::vector<PhysicsEntry>& entries);

  /// At one moment; `by_speed` is left as it is unless asked for.
  void derive(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a, bool speeds);

 private:
  struct Changed {
    ModelPointer model;
    double step = 0;
    std::vector<Eigen::Index> place, entry;  // by tree; -1: none
  };
  const Robot& robot_;
  ModelPointer model_;
  DataPointer data_;
  std::vector<Changed> changed_;
  Eigen::VectorXd torque_, moved_, q_, v_;

  void derive_by_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a, bool speed);
};

}  // namespace diagnose_robot
