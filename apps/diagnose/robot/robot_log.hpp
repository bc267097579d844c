// Recordings of a robot in SI units, one column per joint of the setup.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "../csv.hpp"
#include "setup.hpp"

namespace diagnose_robot {

struct RobotRecording {
  std::string name;
  Eigen::VectorXd time;                 // [s], increasing
  Eigen::MatrixXd angle;                // row x joint; NaN: not measured
  Eigen::MatrixXd goal, torque, speed;  // row x joint; empty where the setup has none
  double torque_late = 0;               // [s] after which torques act on average; see torque_hold.hpp
  double row_period() const { return (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1); }
};

/// Throws surefoot::DiagnoseError that names the column that is missing or cannot be used.
RobotRecording read_recording(const diagnose_program::Csv& csv, const RobotSetup& setup, std::size_t max_rows);

}  // namespace diagnose_robot
