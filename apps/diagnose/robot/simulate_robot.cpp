#include "simulate_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot_step.hpp"

namespace diagnose_robot {
namespace {

constexpr double longest_step = 0.002;  // [s]: of second order that is far below what any encoder sees of a drive

}  // namespace

double simulation_step(const Robot& robot, const RobotRecording& recording) {
  const double period = recording.row_period();
  const double wanted = robot.setup.step > 0 ? robot.setup.step : longest_step;
  return period / std::max(1.0, std::ceil(period / wanted - 1e-6));
}

StartState start_of(const Motion& motion) { return {motion.q.row(0), motion.v.row(0)}; }

Eigen::MatrixXd simulate_robot(const Robot& robot, const RobotRecording& recording, const StartState& start,
                               const RobotPhysics& physics) {
  RobotStep simulation(robot, recording, start, physics);
  const Eigen::Index rows = recording.time.size();
  Eigen::MatrixXd readings =
      Eigen::MatrixXd::Constant(rows, recording.angle.cols(), std::numeric_limits<double>::infinity());
  const double wanted = simulation_step(robot, recording);
  simulation.read(readings, 0);
  for (Eigen::Index k = 0; k + 1 < rows; ++k) {
    const double period = recording.time[k + 1] - recording.time[k];
    const auto steps = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::lround(period / wanted)));
    const double h = period / static_cast<double>(steps);
    for (Eigen::Index s = 0; s < steps; ++s) simulation.step(k, recording.time[k] + static_cast<double>(s) * h, h);
    if (simulation.ran_away()) return readings;
    simulation.read(readings, k + 1);
  }
  return readings;
}

}  // namespace diagnose_robot
