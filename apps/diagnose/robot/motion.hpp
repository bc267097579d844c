// Angles, speeds and accelerations along a recording, by local polynomials that delay nothing.
#pragma once

#include "robot.hpp"

namespace diagnose_robot {

struct Motion {
  Eigen::VectorXd time;           // [s], as recorded
  Eigen::MatrixXd q, v, a;        // row x joint
  Eigen::MatrixXd goal, torque;   // through the same filter; empty where there are none
  double torque_late = 0;         // [s], of the recording
  double half_window = 0;         // [s] of the filter
  double start_gain = 0;          // [1/s] of noise of the sensor in the speed of the first row
  Eigen::VectorXd speed_noise;    // by joint, root mean square of what noise of the sensor makes of speeds
  Eigen::VectorXd low_pass;       // [s] by joint, to either side, of the filter of torques; see low_pass.hpp
  double reach = 0;               // [s] of the window to either side, which has some rows at least
  Eigen::Index edge = 0;          // rows at either end whose window lies to one side: many times the noise of others
};

struct MotionCriteria {
  double half_window = 0;        // [s]; 0: as wide as noise_of() and the motion allow
  Eigen::Index fewest_rows = 4;  // to either side: a cubic and some noise to average
};

Motion smooth(const RobotRecording& recording, const MotionCriteria& criteria = {});

/// Standard deviation of a sensor's white noise from fourth differences, in which the motion hardly shows.
double noise_of(const Eigen::Ref<const Eigen::VectorXd>& readings);

}  // namespace diagnose_robot
