// The walk engine of team Rhoban behind our concept. Needs their library (github.com/Rhoban/IKWalk, MIT licence), whose
// header must be on the include path: configure with -DIKWALK_DIR=<checkout>.
#pragma once

#include <IKWalk.hpp>
#include <cmath>
#include <optional>

#include "walk_engine.hpp"
#include "walk_parameters.hpp"

namespace sigmaban {

inline Rhoban::IKWalkParameters ikwalk_parameters(const WalkParameters& p, const WalkOrders& orders) {
  Rhoban::IKWalkParameters q{};
  q.distHipToKnee = p.leg.hip_to_knee;
  q.distKneeToAnkle = p.leg.knee_to_ankle;
  q.distAnkleToGround = p.leg.ankle_to_ground;
  q.distFeetLateral = p.feet_distance;
  q.freq = p.frequency;
  q.enabledGain = orders.enabled;
  q.stepGain = orders.forward;
  q.lateralGain = orders.left;
  q.turnGain = orders.turn;
  q.supportPhaseRatio = p.support_phase_ratio;
  q.footYOffset = p.foot_y_offset;
  q.riseGain = p.rise;
  q.swingGain = p.swing;
  q.swingRollGain = p.swing_roll;
  q.swingPhase = p.swing_phase;
  q.swingPause = p.swing_pause;
  q.swingVel = p.swing_velocity;
  q.stepUpVel = p.step_up_velocity;
  q.stepDownVel = p.step_down_velocity;
  q.riseUpVel = p.rise_up_velocity;
  q.riseDownVel = p.rise_down_velocity;
  q.trunkXOffset = p.trunk_x_offset;
  q.trunkYOffset = p.trunk_y_offset;
  q.trunkZOffset = p.trunk_z_offset;
  q.trunkPitch = p.trunk_pitch;
  q.trunkRoll = p.trunk_roll;
  q.extraLeftX = p.extra_left.x;
  q.extraLeftY = p.extra_left.y;
  q.extraLeftZ = p.extra_left.z;
  q.extraLeftYaw = p.extra_left.yaw;
  q.extraLeftPitch = p.extra_left.pitch;
  q.extraLeftRoll = p.extra_left.roll;
  q.extraRightX = p.extra_right.x;
  q.extraRightY = p.extra_right.y;
  q.extraRightZ = p.extra_right.z;
  q.extraRightYaw = p.extra_right.yaw;
  q.extraRightPitch = p.extra_right.pitch;
  q.extraRightRoll = p.extra_right.roll;
  return q;
}

/// Same rules as SplineWalk: what is not usable or not finite is not passed on.
class IkWalkAdapter {
 public:
  explicit IkWalkAdapter(const WalkParameters& parameters = {}, double phase = 0)
      : parameters_(parameters), phase_(advance_phase(phase, 0)), usable_(usable(parameters) && std::isfinite(phase)) {}

  const WalkParameters& parameters() const { return parameters_; }
  double phase() const { return phase_; }

  std::optional<JointTargets> step(const WalkOrders& orders, double duration) {
    if (!usable_ || !all_finite(orders) || !std::isfinite(duration * parameters_.frequency)) return std::nullopt;
    double phase = phase_;
    Rhoban::IKWalkOutputs out{};
    if (!Rhoban::IKWalk::walk(ikwalk_parameters(parameters_, orders), duration, phase, out)) return std::nullopt;
    const JointTargets targets{{out.left_hip_yaw, out.left_hip_pitch, out.left_hip_roll, out.left_knee,
                                out.left_ankle_pitch, out.left_ankle_roll},
                               {out.right_hip_yaw, out.right_hip_pitch, out.right_hip_roll, out.right_knee,
                                out.right_ankle_pitch, out.right_ankle_roll}};
    if (!all_finite(targets) || !std::isfinite(phase)) return std::nullopt;
    phase_ = advance_phase(phase, 0);
    return targets;
  }

 private:
  WalkParameters parameters_;
  double phase_;
  bool usable_;
};

static_assert(WalkEngine<IkWalkAdapter>);

}  // namespace sigmaban
