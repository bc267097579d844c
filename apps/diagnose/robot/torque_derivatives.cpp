#include <algorithm>
#include <cmath>

#include "derivatives.hpp"
#include "inverse_dynamics.hpp"
#include "robot_step.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

// How much more torque is needed at a joint, friction by load apart, if it has a bit more of its own property; `given`:
// by the drive.
double needed_by(Property property, const JointPhysics& p, double given, double stretch, double v, double a) {
  switch (property) {
    case Property::coulomb:
      return sign_of(v);
    case Property::viscous:
      return v;
    case Property::breakaway:
      return sign_of(v) * stribeck_share(v);
    case Property::load_friction:
      return sign_of(v) * std::abs(given);
    case Property::drag:
      return v * std::abs(v);
    case Property::armature:
      return a;
    case Property::constant_torque:
      return -1;
    case Property::stiffness:
      return stretch;
    case Property::reading_scale:
      return given / (load_factor(p, v, given) * (1 + p[Property::reading_scale]));
    default:
      return 0;
  }
}

// The same of what acts on the sum of two speeds.
double needed_by_pair(Property property, double v, double a) {
  if (property == Property::pair_coulomb) return sign_of(v);
  if (property == Property::pair_viscous) return v;
  return property == Property::pair_armature ? a : 0;
}

Eigen::VectorXd slope_of(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::Index rows = x.size();
  Eigen::VectorXd slope(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Eigen::Index first = std::max<Eigen::Index>(0, k - 1), last = std::min(rows - 1, k + 1);
    slope[k] = (x[last] - x[first]) / (time[last] - time[first]);
    if (!std::isfinite(slope[k])) slope[k] = 0;  // beside rows that are not known
  }
  return slope;
}

bool is_of_rigid_bodies(Property p) { return is_of_body(p) || p == Property::sensor_bias; }

}  // namespace

std::vector<JointDerivatives> rigid_derivatives(const Robot& robot, const Motion& motion, const RobotPhysics& physics,
                                                const std::vector<PhysicsEntry>& entries) {
  InverseDynamics dynamics(robot, physics, entries);
  std::vector<JointDerivatives> result(robot.joints.size());
  for (const InverseDynamics::Tree& tree : dynamics.trees) {
    for (const int j : tree.joints) {
      JointDerivatives& one = result[static_cast<std::size_t>(j)];
      one.entries = tree.entries;
      one.by.setZero(motion.q.rows(), static_cast<Eigen::Index>(tree.entries.size()));
    }
  }
  Eigen::VectorXd bias(motion.q.cols());
  for (Eigen::Index j = 0; j < bias.size(); ++j) bias[j] = physics[static_cast<std::size_t>(j)][Property::sensor_bias];
  for (Eigen::Index k = 0; k < motion.q.rows(); ++k) {
    dynamics.derive(motion.q.row(k).transpose() - bias, motion.v.row(k), motion.a.row(k), false);
    for (const InverseDynamics::Tree& tree : dynamics.trees) {
      for (std::size_t c = 0; c < tree.entries.size(); ++c) {
        const PhysicsEntry& entry = entries[tree.entries[c]];
        if (!is_of_rigid_bodies(entry.property)) continue;
        const auto column = static_cast<Eigen::Index>(c);
        const auto place = std::ranges::find(tree.joints, entry.joint) - tree.joints.begin();
        for (std::size_t r = 0; r < tree.joints.size(); ++r) {
          const auto at = static_cast<Eigen::Index>(r);
          result[static_cast<std::size_t>(tree.joints[r])].by(k, column) =
              is_of_body(entry.property) ? tree.by_entry(at, column) : -tree.by_angle(at, place);
        }
      }
    }
  }
  return result;
}

std::vector<JointDerivatives> torque_derivatives(const Robot& robot, const Motion& motion, const RobotPhysics& physics,
                                                 const std::vector<PhysicsEntry>& entries,
                                                 const std::vector<JointDerivatives>& rigid) {
  const Eigen::MatrixXd told = arrived_torque(robot, motion, physics);
  const Eigen::MatrixXd read = told - torque_residual(robot, motion, physics);
  std::vector<JointDerivatives> result = rigid;
  for (std::size_t j = 0; j < result.size(); ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    const JointPhysics& p = physics[j];
    const double rest = rest_of_spring(robot, j);
    for (std::size_t e = 0; e < result[j].entries.size(); ++e) {
      const PhysicsEntry& entry = entries[result[j].entries[e]];
      const auto joint = static_cast<std::size_t>(entry.joint);
      const bool pair = is_of_pair(entry.property) && robot.joints[joint].before >= 0;
      const bool here = pair ? joint == j || robot.joints[joint].before == static_cast<int>(j) : joint == j;
      const bool whole = is_of_rigid_bodies(entry.property);
      auto by = result[j].by.col(static_cast<Eigen::Index>(e));
      if (entry.property == Property::delay) {
        by.setZero();
        if (joint == j) by = -slope_of(motion.time, told.col(c));
        continue;
      }
      for (Eigen::Index k = 0; k < by.size(); ++k) {
        const double v = motion.v(k, c), a = motion.a(k, c), stretch = motion.q(k, c) - p[Property::sensor_bias] - rest;
        const double given = read(k, c) / (1 + p[Property::reading_scale]);
        double more = 0;
        if (whole) {
          more = by[k];
        } else if (pair && here) {
          const Eigen::Index other = robot.joints[joint].before;
          more = needed_by_pair(entry.property, motion.v(k, entry.joint) + motion.v(k, other),
                                motion.a(k, entry.joint) + motion.a(k, other));
        } else if (here) {
          more = needed_by(entry.property, p, given, stretch, v, a);
        }
        by[k] = -(1 + p[Property::reading_scale]) * load_factor(p, v, given) * more;
      }
    }
  }
  return result;
}

}  // namespace diagnose_robot
