// How the trunk leans, from gyroscope and accelerometer: a complementary filter.
//
// R. Mahony, T. Hamel, J.-M. Pflimlin: "Nonlinear complementary filters on the special orthogonal group", 2008, without
// its estimate of the gyroscope's bias.
#pragma once

#include <cmath>

#include "body_reading.hpp"

namespace sigmaban {

class Attitude {
 public:
  /// Takes the mean of the last `duration` [s].
  void update(const BodyReading& reading, double duration) {
    const surefoot::Vec<3> turned = up_ + duration * up_.cross(reading.gyro);
    const double felt = reading.accelerometer.norm();
    up_ = turned;
    if (felt > least_felt) up_ += duration / time_constant_s * (reading.accelerometer / felt - turned);
    up_.normalize();
  }

  /// The vertical in the trunk's frame, a unit vector.
  const surefoot::Vec<3>& up() const { return up_; }
  double roll() const { return std::atan2(up_.y(), up_.z()); }                         // > 0 leans to the right [rad]
  double pitch() const { return std::atan2(-up_.x(), std::hypot(up_.y(), up_.z())); }  // > 0 leans forwards [rad]
  /// Leans by more than 45 degrees: no walk does, and nothing that does stands up again by itself.
  bool fallen() const { return up_.z() < std::sqrt(0.5); }

 private:
  static constexpr double time_constant_s = 1.0;  // two walk cycles: within one, the accelerometer feels the steps [s]
  static constexpr double least_felt = 2.0;       // in free fall there is no vertical to feel [m/s^2]
  surefoot::Vec<3> up_ = surefoot::Vec<3>::UnitZ();
};

}  // namespace sigmaban
