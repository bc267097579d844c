#include "swapped_joints.hpp"

#include <Eigen/QR>

#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

// What a command is made of: the angle it leads to, or the torque that moves bodies against friction.
Eigen::MatrixXd features(const Motion& motion, Eigen::Index j, const Eigen::MatrixXd& bodies, bool torque) {
  const Eigen::Index rows = motion.q.rows();
  Eigen::MatrixXd x(rows, torque ? 5 : 3);
  x.col(0).setOnes();
  x.col(1) = motion.v.col(j);
  if (!torque) {
    x.col(2) = motion.q.col(j);
    return x;
  }
  x.col(2) = motion.v.col(j).cwiseSign();
  x.col(3) = motion.a.col(j);
  x.col(4) = bodies.col(j);
  return x;
}

}  // namespace

Eigen::MatrixXd unexplained_commands(const Evidence& evidence) {
  const bool torque = evidence.robot.setup.drive == DriveKind::torque;
  const auto joints = static_cast<Eigen::Index>(evidence.robot.joints.size());
  const Motion& motion = evidence.motions.front();
  const Eigen::MatrixXd bodies =
      torque ? rigid_body_torque(evidence.robot, motion, RobotPhysics(evidence.robot.joints.size()))
             : Eigen::MatrixXd();
  const Eigen::MatrixXd& commands = torque ? motion.torque : motion.goal;
  const Eigen::MatrixXd centred = commands.rowwise() - commands.colwise().mean();
  Eigen::MatrixXd result(joints, joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const Eigen::MatrixXd x = features(motion, j, bodies, torque);
    const Eigen::MatrixXd left = centred - x * x.colPivHouseholderQr().solve(centred);
    result.col(j) =
        (left.colwise().squaredNorm().array() / centred.colwise().squaredNorm().array().max(1e-300)).matrix();
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
