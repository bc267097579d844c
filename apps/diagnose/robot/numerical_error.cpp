#include "numerical_error.hpp"

#include "simulate_robot.hpp"

namespace diagnose_robot {

Eigen::VectorXd numerical_error(const Evidence& evidence) {
  const Robot& robot = evidence.robot;
  const auto joints = static_cast<Eigen::Index>(robot.joints.size());
  if (robot.setup.drive == DriveKind::torque) return Eigen::VectorXd::Zero(joints);
  const RobotRecording& recording = evidence.recordings.front();
  const StartState start = start_of(evidence.motions.front());
  const auto simulated = [&](int finer) { return simulate_robot(robot, recording, start, robot.nominal, finer); };
  constexpr double of_second_order = 4.0 / 3;  // of the change by half the step: what all finer steps change
  const Eigen::MatrixXd difference = of_second_order * (simulated(1) - simulated(2));
  const Eigen::VectorXd rms = (difference.colwise().squaredNorm() / static_cast<double>(difference.rows())).cwiseSqrt();
  return rms.allFinite() ? rms : Eigen::VectorXd::Zero(joints);
}

}  // namespace diagnose_robot
