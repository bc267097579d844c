// Joint angles of a leg (hip yaw, roll, pitch; knee; ankle pitch, roll) that put its foot where it is wanted, in closed
// form. Hip and ankle axes meet in one point each.
//
// All angles between directions are arc cosines, as in the published engine: they agree with it to 1e-13 rad, where an
// angle is within 1e-7 of zero they are off by up to 3e-8 rad, and more exact formulas would be farther from it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "joint_targets.hpp"
#include "walk_parameters.hpp"

namespace sigmaban {

/// A foot in the frame of the trunk (x forward, y left, z up), from the centre of the hip.
struct FootPose {
  Eigen::Vector3d ground;  // the point of the sole below the ankle [m]
  Eigen::Matrix3d axes;    // its rows: forward, left and up of the foot, orthonormal
};

namespace leg_detail {

/// Within rounding of [-1, 1]: a leg stretched to its full length is reachable.
inline std::optional<double> angle_of_cosine(double cosine) {
  constexpr double tolerance = 1e-9;
  if (!(std::abs(cosine) <= 1.0 + tolerance)) return std::nullopt;  // also where it is no number
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// From one unit vector to another, with the sign of its axis along `positive` [rad].
inline double signed_angle(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& positive) {
  const double angle = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
  return std::copysign(angle, from.cross(to).dot(positive));
}

}  // namespace leg_detail

/// None where the foot is out of reach, at the hip's height or above it, or points straight along the leg.
inline std::optional<LegJoints> leg_inverse_kinematics(const LegLengths& leg, const FootPose& foot) {
  using Eigen::Vector3d;
  const Vector3d forward = foot.axes.row(0), left = foot.axes.row(1), up = foot.axes.row(2);
  const Vector3d ankle = foot.ground + leg.ankle_to_ground * up;
  if (!(ankle.z() < 0)) return std::nullopt;

  // The plane of the leg contains the ankle and the foot's forward axis; here is its horizontal direction.
  Vector3d ahead = forward;
  if (forward.z() != 0) {
    ahead = ankle - (ankle.z() / forward.z()) * forward;
    ahead.z() = 0;
    const double length = ahead.norm();
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    ahead /= length;
  }
  if (ahead.x() < 0 || (ahead.x() == 0 && ahead.y() < 0)) ahead = -ahead;
  const Vector3d aside(-ahead.y(), ahead.x(), 0);

  LegJoints joints;
  joints.hip_yaw = std::atan2(ahead.y(), ahead.x());
  joints.hip_roll = std::atan2(ankle.dot(aside), -ankle.z());

  const double thigh = leg.hip_to_knee, shin = leg.knee_to_ankle;
  const double reach = ankle.norm(), reach2 = reach * reach;
  const auto knee = leg_detail::angle_of_cosine((thigh * thigh + shin * shin - reach2) / (2 * thigh * shin));
  const auto at_hip = leg_detail::angle_of_cosine((thigh * thigh + reach2 - shin * shin) / (2 * thigh * reach));
  if (!knee || !at_hip) return std::nullopt;
  joints.knee = std::numbers::pi - *knee;

  const double roll = joints.hip_roll;
  const Vector3d down(-ahead.y() * std::sin(roll), ahead.x() * std::sin(roll), -std::cos(roll));
  joints.hip_pitch = -(leg_detail::signed_angle(ankle / reach, down, aside) + *at_hip);
  const double pitch = leg_detail::signed_angle(ahead, forward, aside);  // of the foot in the plane of the leg
  joints.ankle_pitch = pitch - joints.knee - joints.hip_pitch;
  joints.ankle_roll = leg_detail::signed_angle(ahead.cross(down), left, forward);
  return joints;
}

}  // namespace sigmaban
