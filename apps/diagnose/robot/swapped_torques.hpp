// Joints whose angles were swapped where torques drive: the torques of all joints then belong to another motion.
#pragma once

#include <utility>
#include <vector>

#include "linearize.hpp"

namespace diagnose_robot {

/// What the torques of one joint leave of bodies, friction and inertia along a motion.
struct TorqueMisfit {
  double variance = 0;     // what is left, of the torque's
  double independent = 0;  // errors among the rows
};

/// By joint, along the recordings as they are; or with the angles of two joints exchanged.
std::vector<TorqueMisfit> torque_misfits(const Evidence& evidence, int a = 0, int b = 0);

struct SwappedAngles {
  int a = 0, b = 0;
  double evidence = 0;      // 2 log of the likelihood of all torques, for having swapped them
  bool each_alone = false;  // the torques of a and of b, each by itself, speak for it too
};

SwappedAngles compare_swapped(int a, int b, const std::vector<TorqueMisfit>& as_is,
                              const std::vector<TorqueMisfit>& swapped);

/// Those that are needed at odds of 20 after the choice among all pairs, the most probable first, each joint once.
std::vector<std::pair<int, int>> likely_swaps(std::vector<SwappedAngles> candidates);

/// All pairs of a robot that torques drive.
std::vector<std::pair<int, int>> swapped_torques(const Evidence& evidence);

}  // namespace diagnose_robot
