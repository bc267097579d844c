// Rigid motions of the plane, SE(2): the pose of a frame in another, and displacements between steps.
//
// Conventions: x forward, y left [m], angle counterclockwise [rad]. `a * b` is the pose b, given in the frame a,
// expressed in the frame that a is given in. log and exp use the closed forms of the left Jacobian
// (Sola, Deray, Atchuthan: "A micro Lie theory for state estimation in robotics", 2018, eq. 156 to 158).
#pragma once

#include <cmath>
#include <numbers>

#include "surefoot/core/vec.hpp"

namespace surefoot {

/// The same angle in [-pi, pi). [rad]
inline double wrap_angle(double angle) {
  constexpr double pi = std::numbers::pi;
  if (angle >= -pi && angle < pi) return angle;
  const double wrapped = angle - 2 * pi * std::floor((angle + pi) / (2 * pi));
  return wrapped < -pi || wrapped >= pi ? -pi : wrapped;  // rounding may land on pi itself; not a number stays so
}

/// A pose or displacement in the plane. The angle is kept as given: compose and inverse wrap theirs to [-pi, pi).
struct Pose2 {
  double x = 0;      // [m]
  double y = 0;      // [m]
  double angle = 0;  // [rad]

  /// From and to the vector (x, y, angle).
  static Pose2 from_vec(const Vec<3>& v) { return {v[0], v[1], v[2]}; }
  Vec<3> vec() const { return {x, y, angle}; }
  Vec<2> position() const { return {x, y}; }

  /// A point of this frame, expressed in the frame this pose is given in.
  Vec<2> transform(const Vec<2>& point) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]};
  }

  Pose2 inverse() const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {-c * x - s * y, s * x - c * y, wrap_angle(-angle)};
  }

  /// The pose reached from the identity by moving one unit of time with the constant body velocity
  /// (vx, vy, turn rate) [m, m, rad].
  static Pose2 exp(const Vec<3>& velocity) {
    const double turn = velocity[2];
    const double a = sinc(turn), b = cosc(turn);
    return {a * velocity[0] - b * velocity[1], b * velocity[0] + a * velocity[1], wrap_angle(turn)};
  }

  /// The body velocity, with a turn in [-pi, pi), that exp maps to this pose.
  Vec<3> log() const {
    const double turn = wrap_angle(angle);
    const double a = sinc(turn), b = cosc(turn);
    const double scale = 1.0 / (a * a + b * b);
    return {scale * (a * x + b * y), scale * (a * y - b * x), turn};
  }

  friend Pose2 operator*(const Pose2& a, const Pose2& b) {
    const Vec<2> position = a.transform(b.position());
    return {position[0], position[1], wrap_angle(a.angle + b.angle)};
  }

 private:
  // sin(t) / t and (1 - cos(t)) / t; the series is exact to double precision below the threshold.
  static double sinc(double t) { return std::abs(t) < 1e-4 ? 1.0 - t * t / 6.0 : std::sin(t) / t; }
  static double cosc(double t) {
    if (std::abs(t) < 1e-4) return t * (0.5 - t * t / 24.0);
    const double half = std::sin(0.5 * t);
    return 2.0 * half * half / t;
  }
};

}  // namespace surefoot
