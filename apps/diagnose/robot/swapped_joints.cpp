#include "swapped_joints.hpp"

#include <Eigen/QR>
#include <algorithm>

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

}  // namespace

Eigen::MatrixXd unexplained_commands(const Evidence& evidence) {
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
