// Angles, speeds and accelerations along a recording, by local polynomials that delay nothing.
#pragma once

#include "robot.hpp"

namespace diagnose_robot {

struct Motion {
  Eigen::MatrixXd q, v, a;        // row x joint
  Eigen::MatrixXd goal, torque;   // through the same filter; empty where there are none
  double half_window = 0;         // [s] of the filter
  double acceleration_noise = 0;  // [1/s^2], standard deviation of accelerations for one of the angles' noise
};

struct MotionCriteria {
  double half_window = 0;        // [s]; 0: as wide as noise_of() and the motion allow
  Eigen::Index fewest_rows = 4;  // to either side: a cubic and some noise to average
};

Motion smooth(const RobotRecording& recording, const MotionCriteria& criteria = {});

/// Standard deviation of a sensor's white noise from fourth differences, in which the motion hardly shows.
double noise_of(const Eigen::Ref<const Eigen::VectorXd>& readings);

}  // namespace diagnose_robot
