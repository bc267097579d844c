// The pose from which a robot may go limp: feet where they stand, knees bent as far as the legs allow.
#pragma once

#include <optional>

#include "../walk_engine/spline_walk.hpp"

namespace sigmaban {

/// Both feet flat on the ground under a trunk that is lowered to `height` of the length of straight legs. None where
/// the legs cannot do it.
inline std::optional<JointTargets> sitting_pose(WalkParameters parameters, double height = 0.6) {
  parameters.trunk_z_offset = (1 - height) * parameters.leg.sum();
  parameters.trunk_pitch = 0;
  return walk_targets(parameters, {.forward = 0, .left = 0, .turn = 0, .enabled = 0}, 0);
}

}  // namespace sigmaban
