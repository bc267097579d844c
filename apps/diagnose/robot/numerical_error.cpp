#include "numerical_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "augmented_xml.hpp"
#include "findings.hpp"
#include "low_pass.hpp"
#include "robot_diagnosis.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

constexpr double hardly = 0.8;  // times what it was: estimates of numerical errors are off by as much

// Root mean square by joint of what is known.
Eigen::VectorXd rms_of_known(const Eigen::MatrixXd& x) {
  Eigen::VectorXd rms(x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    double square = 0, rows = 0;
    for (const double one : x.col(j)) {
      if (!std::isfinite(one)) continue;
      square += one * one;
      rows += 1;
    }
    rms[j] = std::sqrt(square / std::max(1.0, rows));
  }
  return rms;
}

}  // namespace

Eigen::VectorXd smoothing_error(const Evidence& evidence, const RobotPhysics& physics) {
  Eigen::VectorXd square = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(evidence.robot.joints.size()));
  for (std::size_t r = 0; r < evidence.motions.size(); ++r) {
    const Motion& motion = evidence.motions[r];
    const Motion wide = smooth(evidence.recordings[r], {std::numbers::sqrt2 * motion.reach});
    const Eigen::MatrixXd more =
        torque_residual(evidence.robot, wide, physics) - torque_residual(evidence.robot, motion, physics);
    square += rms_of_known(low_passed(motion, more)).cwiseAbs2() / static_cast<double>(evidence.motions.size());
  }
  constexpr double of_fourth_order = 1.0 / 3;  // a window that is wider by the root of 2 takes four times as much
  return of_fourth_order * square.cwiseSqrt();
}

Eigen::VectorXd numerical_error(const Evidence& evidence, const RobotPhysics& physics,
                                const std::vector<StartState>& starts) {
  const Robot& robot = evidence.robot;
  const auto joints = static_cast<Eigen::Index>(robot.joints.size());
  if (robot.setup.drive == DriveKind::torque) return Eigen::VectorXd::Zero(joints);
  const mjOption& stated = robot.model.model->opt;
  const AugmentedModel same = augmented_model(robot, physics, stated.timestep, evidence.folder, stated.integrator);
  Eigen::VectorXd square = Eigen::VectorXd::Zero(joints);
  for (std::size_t r = 0; r < evidence.recordings.size() && !evidence.stop.stop_requested(); ++r) {
    const RobotRecording& recording = evidence.recordings[r];
    const Eigen::MatrixXd difference =
        simulate_robot(robot, recording, starts[r], physics) - replay(robot, same, physics, recording, starts[r]);
    const auto rows = static_cast<double>(difference.rows() * static_cast<Eigen::Index>(evidence.recordings.size()));
    square += difference.colwise().squaredNorm().transpose() / rows;
  }
  if (!square.allFinite()) return Eigen::VectorXd::Zero(joints);
  return square.cwiseSqrt();
}

double numerical_share(const Evidence& evidence, const Eigen::MatrixXd& errors) {
  const Eigen::VectorXd rms = rms_by_joint(evidence, errors),
                        noise = noise_by_joint(evidence, evidence.robot.nominal, 1);
  std::vector<double> shares;
  for (Eigen::Index j = 0; j < evidence.numerical.size(); ++j) {
    if (!(evidence.numerical[j] > 0)) continue;
    shares.push_back(std::sqrt(std::max(0.0, rms[j] * rms[j] - noise[j] * noise[j])) / evidence.numerical[j]);
  }
  if (shares.empty()) return 1;
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::ranges::nth_element(shares, middle);
  return std::min(1.0, *middle);
}

double cap_numerical_error(Evidence& evidence, const Eigen::MatrixXd& errors) {
  const double share = numerical_share(evidence, errors);
  if (!(share < hardly)) return 1;
  evidence.numerical *= share;
  return share;
}

bool raise_numerical_error(Evidence& evidence, const RobotPhysics& physics, const std::vector<StartState>& starts,
                           const Eigen::MatrixXd& errors, double share) {
  if (evidence.numerical.isZero(0)) return false;
  const Eigen::VectorXd before = evidence.numerical;
  const Eigen::VectorXd rms = rms_by_joint(evidence, errors),
                        noise = noise_by_joint(evidence, evidence.robot.nominal, 1),
                        left = (rms.cwiseAbs2() - noise.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  evidence.numerical = (share * numerical_error(evidence, physics, starts)).cwiseMin(left);
  const bool larger = (hardly * evidence.numerical.array() > before.array()).any();
  evidence.numerical = larger ? Eigen::VectorXd(evidence.numerical.cwiseMax(before)) : before;
  return larger;
}

bool lower_numerical_error(Evidence& evidence, const Eigen::MatrixXd& errors) {
  constexpr double half = 0.5;
  if (evidence.numerical.isZero(0)) return false;
  double share = numerical_share(evidence, errors);
  const double noise = noise_by_joint(evidence, evidence.robot.nominal, 1).squaredNorm();
  const double numerical = evidence.numerical.squaredNorm(), beyond = VerdictCriteria().beyond_noise;
  const bool unexplained = rms_by_joint(evidence, errors).squaredNorm() > beyond * beyond * (noise + numerical);
  if (unexplained && numerical > noise) share = std::min(share, half);
  if (!(share < hardly)) return false;
  evidence.numerical *= share;
  return true;
}

}  // namespace diagnose_robot
