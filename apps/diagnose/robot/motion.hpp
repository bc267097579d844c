// Angles, speeds and accelerations along a recording, by local polynomials that delay nothing.
#pragma once

#include "robot.hpp"

namespace diagnose_robot {

struct Motion {
  Eigen::MatrixXd q, v, a;       // row x joint
  Eigen::MatrixXd goal, torque;  // through the same filter; empty where there are none
};

struct MotionCriteria {
  double half_window = 0.02;     // [s]: motors and links of robots move at up to some 10 Hz
  Eigen::Index fewest_rows = 4;  // to either side: a cubic and some noise to average
};

Motion smooth(const RobotRecording& recording, const MotionCriteria& criteria = {});

}  // namespace diagnose_robot
