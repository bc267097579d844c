// Where the feet are at a phase of the walk: cubic splines over the cycle, then the lean of the trunk.
//
// After the engine of team Rhoban (Q. Rouxel, G. Passault, L. Hofer, S. N'Guyen, O. Ly: "Rhoban hardware and software
// open source contributions for RoboCup humanoids", 2015): each foot stands for the share L of the cycle.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "leg_inverse_kinematics.hpp"
#include "spline.hpp"
#include "walk_engine.hpp"
#include "walk_parameters.hpp"

namespace sigmaban {

/// The curves of a cycle, without unit. Phases in [0,1).
namespace walk_curve {

/// The share of the cycle for which a foot is on the ground.
inline double on_ground(const WalkParameters& p) { return 0.5 + 0.5 * p.support_phase_ratio; }

/// Forward position of a foot: from 0.5 to -0.5 on the ground, and back in the air.
inline double step(const WalkParameters& p, double phase) {
  const double lift = on_ground(p), slope = -1.0 / lift;
  return evaluate_spline(
      std::array<Knot, 4>{
          {{0, 0.5, slope}, {lift, -0.5, slope}, {lift, -0.5, p.step_up_velocity}, {1, 0.5, -p.step_down_velocity}}},
      phase);
}

/// Height of a foot, 0 to 1.
inline double rise(const WalkParameters& p, double phase) {
  const double lift = on_ground(p);
  return evaluate_spline(std::array<Knot, 5>{{{0, 0, 0},
                                              {lift, 0, 0},
                                              {lift, 0, p.rise_up_velocity},
                                              {0.5 * (1 + lift), 1, 0},
                                              {1, 0, -p.rise_down_velocity}}},
                         phase);
}

/// Turn of a foot, 0 to 1: it turns out before the other one leaves the ground, and back in the air.
inline double turn(const WalkParameters& p, double phase) {
  const double lift = on_ground(p);
  return evaluate_spline(std::array<Knot, 5>{{{0, 0, 0}, {lift - 0.5, 0, 0}, {0.5, 1, 0}, {lift, 1, 0}, {1, 0, 0}}},
                         phase);
}

/// Sideways position of the trunk, -1 to 1.
inline double swing(const WalkParameters& p, double phase) {
  const double half = 0.5 * p.swing_pause, v = p.swing_velocity;
  return evaluate_spline(std::array<Knot, 10>{{{0, -1, 0},
                                               {half, -1, 0},
                                               {half, -1, v},
                                               {0.5 - half, 1, v},
                                               {0.5 - half, 1, 0},
                                               {0.5 + half, 1, 0},
                                               {0.5 + half, 1, -v},
                                               {1 - half, -1, -v},
                                               {1 - half, -1, 0},
                                               {1, -1, 0}}},
                         phase);
}

}  // namespace walk_curve

/// Both feet, each from its own hip.
struct FeetPoses {
  FootPose left, right;
};

/// At a phase in [0,1) of the left foot; the right one is half a cycle ahead.
inline FeetPoses feet_poses(const WalkParameters& p, const WalkOrders& orders, double phase) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const double gain = orders.enabled;
  const double sway = gain * walk_curve::swing(p, advance_phase(0.5 + phase, p.swing_phase));
  const double trunk_roll = p.trunk_roll - p.swing_roll * sway;
  const double tan_roll = std::tan(trunk_roll);
  const Eigen::Matrix3d lean = (AngleAxisd(-p.trunk_pitch, Vector3d::UnitY()) *  //
                                AngleAxisd(-trunk_roll, Vector3d::UnitX()))
                                   .toRotationMatrix();

  const auto foot = [&](double at, double side, const FootOffset& extra) {  // side: 1 is left, -1 is right
    const double step = walk_curve::step(p, at);
    const double outwards = std::copysign(0.5, orders.left >= 0 ? side : -side);
    const Vector3d flat(gain * orders.forward * step + extra.x,
                        p.swing * sway + gain * orders.left * (step + outwards) + side * p.foot_y_offset + extra.y,
                        gain * p.rise * walk_curve::rise(p, at) + p.trunk_z_offset + extra.z);
    Vector3d position = lean * flat - Vector3d(p.trunk_x_offset, p.trunk_y_offset, 0);
    if (side * trunk_roll < 0) position.z() += p.feet_distance * std::abs(tan_roll);
    position.x() += p.leg.sum() * std::tan(p.trunk_pitch);
    position.y() -= p.leg.sum() * tan_roll;
    position.z() -= p.leg.sum();
    const Eigen::Matrix3d axes =
        (AngleAxisd(gain * orders.turn * walk_curve::turn(p, at) + extra.yaw, Vector3d::UnitZ()) *
         AngleAxisd(trunk_roll + extra.roll, Vector3d::UnitX()) *
         AngleAxisd(p.trunk_pitch + extra.pitch, Vector3d::UnitY()))
            .toRotationMatrix();
    return FootPose{position, axes};
  };
  return {foot(phase, 1, p.extra_left), foot(advance_phase(phase, 0.5), -1, p.extra_right)};
}

}  // namespace sigmaban
