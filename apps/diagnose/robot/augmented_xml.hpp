// The corrected model: MJCF with what was found in it, a C++ header for what MJCF cannot say, and a replay of both.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "robot_diagnosis.hpp"
#include "robot_log.hpp"
#include "robot_model.hpp"
#include "simulate_robot.hpp"

namespace diagnose_robot {

/// Steps of MuJoCo (Runge-Kutta of fourth order, but drives and friction change at whole steps) for one of ours: as few
/// as replay what was simulated.
inline constexpr std::array<double, 2> steps_of_ours{4, 16};

struct AugmentedModel {
  std::string xml, header;
  std::vector<AugmentedEntry> table;
};

/// `step`: of the model [s]; `integrator`: mjINT_RK4, or that of the file. `folder`: of the model file. Throws
/// surefoot::DiagnoseError if MuJoCo cannot write the model.
AugmentedModel augmented_model(const Robot& robot, const RobotPhysics& physics, double step,
                               const std::filesystem::path& folder, int integrator = mjINT_RK4);

/// Angles from MuJoCo's own step over the recording: row x joint, infinite from where it runs away. Contacts are
/// switched off.
Eigen::MatrixXd replay(const Robot& robot, const AugmentedModel& augmented, const RobotPhysics& physics,
                       const RobotRecording& recording, const StartState& start);

}  // namespace diagnose_robot
