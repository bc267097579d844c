#include "inverse_dynamics.hpp"

#include <algorithm>

namespace diagnose_robot {
namespace {

constexpr double difference = 1e-6;       // [rad], [rad/s]
constexpr double body_difference = 1e-4;  // [1], [m], [kg]: torques are nearly linear in these

}  // namespace

std::vector<std::vector<int>> joints_by_tree(const Robot& robot) {
  std::vector<std::vector<int>> result(static_cast<std::size_t>(robot.trees));
  for (std::size_t j = 0; j < robot.joints.size(); ++j)
    result[static_cast<std::size_t>(robot.joints[j].tree)].push_back(static_cast<int>(j));
  return result;
}

void rigid_body_torque(const Robot& robot, const mjModel* m, mjData* d, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& v, const Eigen::VectorXd& a, Eigen::VectorXd& torque) {
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const ModelJoint& joint = robot.joints[j].model;
    const auto c = static_cast<Eigen::Index>(j);
    d->qpos[joint.position] = q[c];
    d->qvel[joint.dof] = v[c];
    d->qacc[joint.dof] = a[c];
  }
  mj_kinematics(m, d);
  mj_comPos(m, d);
  mj_comVel(m, d);
  mj_rne(m, d, 1, d->qfrc_inverse);
  torque.resize(q.size());
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const ModelJoint& joint = robot.joints[j].model;
    const double spring = m->jnt_stiffness[joint.id] * (d->qpos[joint.position] - m->qpos_spring[joint.position]);
    torque[static_cast<Eigen::Index>(j)] = d->qfrc_inverse[joint.dof] + spring;
  }
}

InverseDynamics::InverseDynamics(const Robot& robot, const RobotPhysics& physics,
                                 const std::vector<PhysicsEntry>& entries)
    : robot_(robot), model_(model_with_bodies(robot, physics)), data_(mj_makeData(model_.get())) {
  const auto joints = joints_by_tree(robot);
  std::size_t longest = 0;
  for (const std::vector<int>& own : joints) {
    longest = std::max(longest, own.size());
    Tree tree;
    tree.joints = own;
    for (std::size_t e = 0; e < entries.size(); ++e) {
      if (std::ranges::find(own, entries[e].joint) != own.end()) tree.entries.push_back(e);
    }
    const auto size = static_cast<Eigen::Index>(own.size());
    tree.by_angle.setZero(size, size);
    tree.by_speed.setZero(size, size);
    tree.by_entry.setZero(size, static_cast<Eigen::Index>(tree.entries.size()));
    trees.push_back(std::move(tree));
  }
  for (const PropertyInfo& info : property_table()) {
    if (!is_of_body(info.property)) continue;
    for (std::size_t place = 0; place < longest; ++place) {
      Changed changed;
      changed.step = body_difference;
      RobotPhysics moved = physics;
      bool any = false;
      for (const Tree& tree : trees) {
        changed.place.push_back(-1);
        changed.entry.push_back(-1);
        for (std::size_t c = 0; c < tree.entries.size() && place < tree.joints.size(); ++c) {
          const PhysicsEntry& entry = entries[tree.entries[c]];
          if (entry.property != info.property || entry.joint != tree.joints[place]) continue;
          changed.place.back() = static_cast<Eigen::Index>(place);
          changed.entry.back() = static_cast<Eigen::Index>(c);
          moved[static_cast<std::size_t>(entry.joint)][info.property] += body_difference;
          any = true;
        }
      }
      if (!any) continue;
      changed.model = model_with_bodies(robot, moved);
      changed_.push_back(std::move(changed));
    }
  }
}

void InverseDynamics::derive_by_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                                       bool speed) {
  std::size_t longest = 0;
  for (const Tree& tree : trees) longest = std::max(longest, tree.joints.size());
  for (std::size_t place = 0; place < longest; ++place) {
    q_ = q;
    v_ = v;
    for (const Tree& tree : trees) {
      if (place < tree.joints.size()) (speed ? v_ : q_)[tree.joints[place]] += difference;
    }
    rigid_body_torque(robot_, model_.get(), data_.get(), q_, v_, a, moved_);
    for (Tree& tree : trees) {
      Eigen::MatrixXd& by = speed ? tree.by_speed : tree.by_angle;
      for (std::size_t r = 0; r < tree.joints.size() && place < tree.joints.size(); ++r) {
        const int j = tree.joints[r];
        by(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(place)) = (moved_[j] - torque_[j]) / difference;
      }
    }
  }
}

void InverseDynamics::derive(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                             bool speeds) {
  rigid_body_torque(robot_, model_.get(), data_.get(), q, v, a, torque_);
  derive_by_motion(q, v, a, false);
  if (speeds) derive_by_motion(q, v, a, true);
  for (const Changed& changed : changed_) {
    rigid_body_torque(robot_, changed.model.get(), data_.get(), q, v, a, moved_);
    for (std::size_t t = 0; t < trees.size(); ++t) {
      if (changed.entry[t] < 0) continue;
      for (std::size_t r = 0; r < trees[t].joints.size(); ++r) {
        const int j = trees[t].joints[r];
        trees[t].by_entry(static_cast<Eigen::Index>(r), changed.entry[t]) = (moved_[j] - torque_[j]) / changed.step;
      }
    }
  }
}

}  // namespace diagnose_robot
