#include "stuck_sensor.hpp"

#include <cmath>

#include "../names.hpp"
#include "../wording.hpp"

namespace diagnose_robot {
namespace {

constexpr double surely_moves = 0.02;  // [rad], [m]: some steps of the coarsest encoders of robots

double way(const Eigen::Ref<const Eigen::VectorXd>& angle) { return angle.maxCoeff() - angle.minCoeff(); }

}  // namespace

std::string stuck_sensor(const Evidence& evidence, std::size_t recording) {
  const Robot& robot = evidence.robot;
  const RobotRecording& log = evidence.recordings[recording];
  if (robot.setup.drive == DriveKind::torque) return "";
  Eigen::MatrixXd simulated;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    if (way(log.angle.col(c)) > 0) continue;
    if (simulated.size() == 0)
      simulated = simulate_robot(robot, log, start_of(evidence.motions[recording]), robot.nominal);
    const double moves = way(simulated.col(c));
    if (!std::isfinite(moves) || moves < surely_moves) continue;
    const JointSetup& joint = robot.joints[j].setup;
    const std::string unit = robot.joints[j].model.slides ? " m" : " rad";
    return log.name + ": " + diagnose_program::in_quotes(joint.angle.name) + " is stuck at " +
           diagnose_program::rounded(log.angle(0, c)) + unit + ", while the model moves by " +
           diagnose_program::rounded(moves) + unit + "; mend the sensor and record again, or list " +
           diagnose_program::in_quotes(joint.name) + " under held if it did not move";
  }
  return "";
}

}  // namespace diagnose_robot
