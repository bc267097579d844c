// Recorded walks of the robot of the paper, made up: its correction and noise, random commands, poses after every
// cycle.
#pragma once

#include <cstdint>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace toys {

inline surefoot::FullLinearCorrection paper_walk() {
  return surefoot::FullLinearCorrection::from_parameters(
      surefoot::Vec<12>{0.0093, 1.30, -0.17, 0.001, -0.0026, -0.075, 1.47, 0.101, 0.0002, -0.35, 0.05, 0.909});
}

inline surefoot::UniformNoise paper_noise() { return {{0.02, 0.02, 0.0873}}; }

/// Poses that are known exactly.
inline constexpr surefoot::PoseAccuracy exact{.position = 0, .heading = 0};

/// `count` sequences of `cycles` cycles with a pose after each.
template <surefoot::MotionModel M, surefoot::NoiseModel N>
std::vector<surefoot::WalkSequence> walks(const M& model, const N& noise, int count, std::uint64_t seed,
                                          int cycles = 25, const surefoot::PoseAccuracy& accuracy = exact) {
  std::vector<surefoot::WalkSequence> result;
  for (const Eigen::Matrix3Xd& commands : surefoot::plan_commands({}, count, cycles, seed)) {
    surefoot::Rng rng(seed, result.size(), 1);
    result.push_back(surefoot::simulate_walk(model, noise, accuracy, surefoot::planned_sequence(commands, true), rng));
  }
  return result;
}

inline std::vector<surefoot::WalkSequence> final_poses(std::vector<surefoot::WalkSequence> sequences) {
  for (surefoot::WalkSequence& sequence : sequences) sequence = final_pose_only(sequence);
  return sequences;
}

}  // namespace toys
