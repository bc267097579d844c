// What the sensors of the robot's body say: gyroscope and accelerometer in the trunk, load cells in the feet.
#pragma once

#include <array>

#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// Trunk frame: x forward, y left, z up.
struct BodyReading {
  surefoot::Vec<3> gyro = surefoot::Vec<3>::Zero();           // [rad/s]
  surefoot::Vec<3> accelerometer = surefoot::Vec<3>::Zero();  // upright at rest (0, 0, 9.81) [m/s^2]
  std::array<double, 2> loads{};                              // under the left and the right foot [N]
  std::array<double, 2> pressure_x{};  // of the centre of pressure, ahead of the foot's middle [m]
};

}  // namespace sigmaban
