#include "numerical_error.hpp"

#include "augmented_xml.hpp"

namespace diagnose_robot {

Eigen::VectorXd numerical_error(const Evidence& evidence, const std::filesystem::path& folder) {
  const Robot& robot = evidence.robot;
  const auto joints = static_cast<Eigen::Index>(robot.joints.size());
  if (robot.setup.drive == DriveKind::torque) return Eigen::VectorXd::Zero(joints);
  const RobotRecording& recording = evidence.recordings.front();
  const StartState start = start_of(evidence.motions.front());
  const mjOption& stated = robot.model.model->opt;
  const AugmentedModel same = augmented_model(robot, robot.nominal, stated.timestep, folder, stated.integrator);
  const Eigen::MatrixXd difference =
      simulate_robot(robot, recording, start, robot.nominal) - replay(robot, same, robot.nominal, recording, start);
  const Eigen::VectorXd rms = (difference.colwise().squaredNorm() / static_cast<double>(difference.rows())).cwiseSqrt();
  return rms.allFinite() ? rms : Eigen::VectorXd::Zero(joints);
}

}  // namespace diagnose_robot
