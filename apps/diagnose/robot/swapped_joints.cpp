#include "swapped_joints.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

// Fraction of the variance of each command that its features leave.
double unexplained(const Eigen::VectorXd& command, const Eigen::MatrixXd& features) {
  const Eigen::VectorXd centred = command.array() - command.mean();
  const Eigen::VectorXd left = centred - features * features.colPivHouseholderQr().solve(centred);
  return left.squaredNorm() / std::max(1e-300, centred.squaredNorm());
}

// A goal is made of the angle that it leads to.
Eigen::MatrixXd angle_features(const Motion& motion, Eigen::Index j) {
  Eigen::MatrixXd x(motion.q.rows(), 3);
  x << Eigen::VectorXd::Ones(motion.q.rows()), motion.v.col(j), motion.q.col(j);
  return x;
}

// Some of the rows: enough for a few features.
Motion thinned(const Motion& motion) {
  constexpr Eigen::Index rows = 600;
  const Eigen::Index stride = std::max<Eigen::Index>(1, motion.q.rows() / rows);
  const auto kept = Eigen::seq(0, motion.q.rows() - 1, stride);
  Motion result;
  result.q = motion.q(kept, Eigen::all);
  result.v = motion.v(kept, Eigen::all);
  result.a = motion.a(kept, Eigen::all);
  result.torque = motion.torque(kept, Eigen::all);
  return result;
}

// A torque moves bodies against friction.
double unexplained_torque(const Motion& motion, const Eigen::MatrixXd& bodies, Eigen::Index j) {
  Eigen::MatrixXd x(motion.q.rows(), 5);
  x << Eigen::VectorXd::Ones(motion.q.rows()), motion.v.col(j), motion.v.col(j).cwiseSign(), motion.a.col(j),
      bodies.col(j);
  return unexplained(motion.torque.col(j), x);
}

}  // namespace

Eigen::MatrixXd unexplained_torques(const Evidence& evidence) {
  const auto joints = static_cast<Eigen::Index>(evidence.robot.joints.size());
  const RobotPhysics rigid(evidence.robot.joints.size());
  Motion motion = thinned(evidence.motions.front());
  Eigen::MatrixXd result = Eigen::MatrixXd::Ones(joints, joints);
  const Eigen::MatrixXd bodies = rigid_body_torque(evidence.robot, motion, rigid);
  for (Eigen::Index j = 0; j < joints; ++j) result(j, j) = unexplained_torque(motion, bodies, j);
  const auto swap = [&](Eigen::Index a, Eigen::Index b) {
    for (Eigen::MatrixXd* matrix : {&motion.q, &motion.v, &motion.a}) matrix->col(a).swap(matrix->col(b));
  };
  for (Eigen::Index a = 0; a < joints; ++a) {
    for (Eigen::Index b = a + 1; b < joints; ++b) {
      swap(a, b);
      const Eigen::MatrixXd moved = rigid_body_torque(evidence.robot, motion, rigid);
      result(a, b) = unexplained_torque(motion, moved, a);
      result(b, a) = unexplained_torque(motion, moved, b);
      swap(a, b);
    }
  }
  return result;
}

Eigen::MatrixXd unexplained_commands(const Evidence& evidence) {
  if (evidence.robot.setup.drive == DriveKind::torque) return unexplained_torques(evidence);
  const auto joints = static_cast<Eigen::Index>(evidence.robot.joints.size());
  const Motion& motion = evidence.motions.front();
  Eigen::MatrixXd result(joints, joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const Eigen::MatrixXd x = angle_features(motion, j);
    for (Eigen::Index i = 0; i < joints; ++i) result(i, j) = unexplained(motion.goal.col(i), x);
  }
  return result;
}

std::vector<std::pair<int, int>> swapped_pairs(const Eigen::MatrixXd& unexplained, const SwapCriteria& criteria) {
  std::vector<std::pair<int, int>> pairs;
  for (Eigen::Index i = 0; i < unexplained.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < unexplained.cols(); ++j) {
      const double swapped = unexplained(i, j) + unexplained(j, i), as_is = unexplained(i, i) + unexplained(j, j);
      const bool belong = unexplained(i, j) < criteria.explained && unexplained(j, i) < criteria.explained;
      if (belong && swapped < criteria.share * as_is) pairs.emplace_back(static_cast<int>(i), static_cast<int>(j));
    }
  }
  return pairs;
}

}  // namespace diagnose_robot
