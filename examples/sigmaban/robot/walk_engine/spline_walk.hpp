// Our walk engine: feet on splines, legs by inverse kinematics.
#pragma once

#include <cmath>
#include <optional>

#include "foot_path.hpp"
#include "leg_inverse_kinematics.hpp"
#include "walk_engine.hpp"
#include "walk_parameters.hpp"

namespace sigmaban {

/// Both legs at a phase in [0,1), for parameters that are usable. None where a foot cannot get.
inline std::optional<JointTargets> walk_targets(const WalkParameters& parameters, const WalkOrders& orders,
                                                double phase) {
  const FeetPoses feet = feet_poses(parameters, orders, phase);
  const auto left = leg_inverse_kinematics(parameters.leg, feet.left);
  const auto right = leg_inverse_kinematics(parameters.leg, feet.right);
  if (!left || !right) return std::nullopt;
  const JointTargets targets{*left, *right};
  if (!all_finite(targets)) return std::nullopt;
  return targets;
}

/// About a microsecond per step; no allocation.
class SplineWalk {
 public:
  /// Parameters that are not usable() and phases that are not finite make every step unreachable.
  explicit SplineWalk(const WalkParameters& parameters = {}, double phase = 0)
      : parameters_(parameters), phase_(advance_phase(phase, 0)), usable_(usable(parameters) && std::isfinite(phase)) {}

  const WalkParameters& parameters() const { return parameters_; }

  /// Of the left foot, in [0,1): it touches the ground at 0.
  double phase() const { return phase_; }

  /// For `duration` [s] of any sign.
  std::optional<JointTargets> step(const WalkOrders& orders, double duration) {
    const double next = advance_phase(phase_, duration * parameters_.frequency);
    if (!usable_ || !all_finite(orders) || !std::isfinite(next)) return std::nullopt;
    const auto targets = walk_targets(parameters_, orders, phase_);
    if (targets) phase_ = next;
    return targets;
  }

 private:
  WalkParameters parameters_;
  double phase_;
  bool usable_;
};

static_assert(WalkEngine<SplineWalk>);

}  // namespace sigmaban
