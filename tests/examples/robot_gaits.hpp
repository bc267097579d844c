// Walks and legs that the tests of the walk engine share.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "examples/sigmaban/robot/walk_engine/leg_inverse_kinematics.hpp"
#include "examples/sigmaban/robot/walk_engine/walk_parameter_names.hpp"
#include "surefoot/core/rng.hpp"

namespace sigmaban {

/// What must be there; ends the test case where it is not.
template <class Value>
Value there(const std::optional<Value>& value) {
  if (!value) throw std::runtime_error("not reachable");
  return *value;
}

/// Where the joints put the foot: the chain of joint_targets.hpp, multiplied out.
inline FootPose foot_of(const LegLengths& leg, const LegJoints& q) {
  using Eigen::AngleAxisd, Eigen::Matrix3d, Eigen::Vector3d;
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Matrix3d thigh = (AngleAxisd(q.hip_yaw, z) * AngleAxisd(q.hip_roll, x) * AngleAxisd(q.hip_pitch, y)).matrix();
  const Matrix3d shin = thigh * AngleAxisd(q.knee, y).matrix();
  const Matrix3d foot = shin * AngleAxisd(q.ankle_pitch, y).matrix() * AngleAxisd(q.ankle_roll, x).matrix();
  const Vector3d ground =
      -leg.hip_to_knee * thigh.col(2) - leg.knee_to_ankle * shin.col(2) - leg.ankle_to_ground * foot.col(2);
  return {ground, foot.transpose()};
}

/// A number of any kind a program may be handed by mistake, around `scale`.
inline double absurd_number(surefoot::Rng& rng, double scale) {
  switch (rng.below(12)) {
    case 0:
      return 0.0;
    case 1:
      return rng.uniform() < 0.5 ? -1.0 : 1.0;
    case 2:
      return std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(2000)) - 1000);
    case 3:
      return rng.uniform() < 0.5 ? HUGE_VAL : -HUGE_VAL;
    case 4:
      return NAN;
    case 5:
      return rng.uniform(-4, 4);
    default:
      return scale * rng.uniform(-2, 2);
  }
}

/// Around the default walk, with up to two parameters or orders absurd.
inline WalkSettings absurd_settings(surefoot::Rng& rng) {
  WalkSettings s;
  WalkParameters& p = s.parameters;
  s.orders = {rng.uniform(-0.06, 0.06), rng.uniform(-0.06, 0.06), rng.uniform(-0.6, 0.6), rng.uniform()};
  const auto near = [&](double& value, double spread) { value += spread * rng.uniform(-1, 1); };
  near(p.foot_y_offset, 0.05), near(p.rise, 0.05), near(p.swing, 0.03), near(p.swing_roll, 0.3);
  near(p.swing_phase, 0.5), near(p.trunk_x_offset, 0.05), near(p.trunk_y_offset, 0.05), near(p.trunk_z_offset, 0.03);
  near(p.trunk_pitch, 0.5), near(p.trunk_roll, 0.3), near(p.step_up_velocity, 4), near(p.rise_up_velocity, 4);
  near(p.leg.hip_to_knee, 0.05), near(p.leg.knee_to_ankle, 0.05), near(p.leg.ankle_to_ground, 0.02);
  p.support_phase_ratio = std::min(1.0, rng.uniform(0, 1.2));
  p.swing_pause = std::min(0.5, rng.uniform(0, 0.6));
  constexpr const char* names[] = {
      "step",          "lateral",       "turn",          "enabled",        "hip_knee",       "knee_ankle",
      "ankle_ground",  "feet_distance", "freq",          "foot_y_offset",  "rise",           "support_phase_ratio",
      "swing",         "swing_roll",    "swing_phase",   "swing_pause",    "swing_vel",      "step_up_vel",
      "step_down_vel", "rise_up_vel",   "rise_down_vel", "trunk_x_offset", "trunk_y_offset", "trunk_z_offset",
      "trunk_pitch",   "trunk_roll",    "extra_left_x",  "extra_right_z",  "extra_left_yaw", "extra_left_roll"};
  for (std::uint32_t changes = rng.below(3); changes > 0; --changes) {
    *find_setting(s, names[rng.below(std::size(names))]) = absurd_number(rng, 0.1);
  }
  return s;
}

/// Left and right changed places.
inline LegJoints mirrored(const LegJoints& q) {
  return {-q.hip_yaw, q.hip_pitch, -q.hip_roll, q.knee, q.ankle_pitch, -q.ankle_roll};
}

}  // namespace sigmaban
