#include "robot_log.hpp"

#include <algorithm>
#include <cmath>

#include "../names.hpp"
#include "surefoot/core/error.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::in_quotes;
using surefoot::DiagnoseError;

constexpr Eigen::Index fewest_rows = 50;  // fewer give no speeds and accelerations worth the name

void fill(Eigen::MatrixXd& target, Eigen::Index j, Eigen::Index joints, const diagnose_program::Csv& csv,
          const ColumnOf& column, const std::string& why, Eigen::Index rows) {
  if (column.name.empty()) return;
  const std::vector<double>& values = diagnose_program::numbers(csv, column.name, why);
  if (target.size() == 0) target = Eigen::MatrixXd::Constant(rows, joints, std::nan(""));
  for (Eigen::Index k = 0; k < rows; ++k) target(k, j) = column.factor * values[static_cast<std::size_t>(k)];
}

// Commands hold until the next row that has one.
void hold_last(Eigen::MatrixXd& commands, const std::string& file) {
  for (Eigen::Index j = 0; j < commands.cols(); ++j) {
    for (Eigen::Index k = 0; k < commands.rows(); ++k) {
      if (std::isfinite(commands(k, j))) continue;
      if (k == 0)
        throw DiagnoseError(file + ": a goal or torque is empty in the first row; begin where all commands are known");
      commands(k, j) = commands(k - 1, j);
    }
  }
}

// Readings that are missing lie on the line between their neighbours.
void bridge_gaps(Eigen::MatrixXd& readings, const Eigen::VectorXd& t, const std::string& file,
                 const RobotSetup& setup) {
  for (Eigen::Index j = 0; j < readings.cols(); ++j) {
    Eigen::Index last = -1;
    for (Eigen::Index k = 0; k < readings.rows(); ++k) {
      if (!std::isfinite(readings(k, j))) continue;
      for (Eigen::Index i = last + 1; i < k; ++i) {
        readings(i, j) =
            last < 0 ? readings(k, j)
                     : readings(last, j) + (readings(k, j) - readings(last, j)) * (t[i] - t[last]) / (t[k] - t[last]);
      }
      last = k;
    }
    if (last < 0) {
      const JointSetup& joint = setup.joints[static_cast<std::size_t>(j)];
      throw DiagnoseError(file + ": the column " + in_quotes(joint.angle.name) + " is empty; log it, or list " +
                          in_quotes(joint.name) + " under held if it did not move");
    }
    for (Eigen::Index i = last + 1; i < readings.rows(); ++i) readings(i, j) = readings(last, j);
  }
}

}  // namespace

RobotRecording read_recording(const diagnose_program::Csv& csv, const RobotSetup& setup, std::size_t max_rows) {
  RobotRecording recording;
  recording.name = csv.file;
  const auto rows = static_cast<Eigen::Index>(std::min(csv.rows(), max_rows));
  const auto joints = static_cast<Eigen::Index>(setup.joints.size());
  if (rows < fewest_rows) {
    throw DiagnoseError(csv.file + ": " + std::to_string(rows) + " rows are too few; record at least " +
                        std::to_string(fewest_rows));
  }
  const std::vector<double>& time = diagnose_program::numbers(csv, setup.time, "the time of the setup");
  recording.time.resize(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    recording.time[k] = setup.time_factor * time[static_cast<std::size_t>(k)];
    if (k > 0 && !(recording.time[k] > recording.time[k - 1])) {
      throw DiagnoseError(csv.file + ", line " + std::to_string(csv.lines[static_cast<std::size_t>(k)]) +
                          ": the time does not increase; remove the row or sort the file");
    }
  }
  for (Eigen::Index j = 0; j < joints; ++j) {
    const JointSetup& joint = setup.joints[static_cast<std::size_t>(j)];
    const std::string why = "that " + setup.file + " names for the joint " + in_quotes(joint.name);
    fill(recording.angle, j, joints, csv, joint.angle, why, rows);
    fill(recording.goal, j, joints, csv, joint.goal, why, rows);
    fill(recording.torque, j, joints, csv, joint.torque, why, rows);
    fill(recording.speed, j, joints, csv, joint.speed, why, rows);
  }
  bridge_gaps(recording.angle, recording.time, csv.file, setup);
  if (setup.drive == DriveKind::position) hold_last(recording.goal, csv.file);
  if (setup.drive == DriveKind::torque) hold_last(recording.torque, csv.file);
  return recording;
}

}  // namespace diagnose_robot
