// Recorded walks of the robot of the paper, made up: its correction and noise, random orders, poses after every cycle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/motion_noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace toys {

inline surefoot::FullLinearCorrection paper_walk() {
  return surefoot::FullLinearCorrection::from_parameters(
      surefoot::Vec<12>{0.0093, 1.30, -0.17, 0.001, -0.0026, -0.075, 1.47, 0.101, 0.0002, -0.35, 0.05, 0.909});
}

inline surefoot::UniformNoise paper_noise() { return {{0.02, 0.02, 0.0873}}; }

/// `count` sequences of `cycles` cycles; every pose is known exactly.
template <surefoot::MotionModel M, surefoot::NoiseModel N>
std::vector<surefoot::WalkSequence> walks(const M& model, const N& noise, int count, std::uint64_t seed,
                                          int cycles = 25) {
  std::vector<surefoot::WalkSequence> result;
  for (int s = 0; s < count; ++s) {
    surefoot::Rng rng(seed, static_cast<std::uint64_t>(s));
    surefoot::WalkSequence sequence;
    sequence.name = std::to_string(s);
    sequence.orders.resize(3, cycles);
    sequence.poses.resize(3, cycles);
    surefoot::Vec<3> orders = surefoot::Vec<3>::Zero();
    surefoot::Pose2 pose;
    for (int i = 0; i < cycles; ++i) {
      const surefoot::Vec<3> previous = orders;
      const surefoot::Vec<3> change{rng.uniform(-0.04, 0.04), rng.uniform(-0.02, 0.02), rng.uniform(-0.3, 0.3)};
      orders = (orders + change).cwiseMax(surefoot::Vec<3>(-0.04, -0.04, -0.4));
      orders = orders.cwiseMin(surefoot::Vec<3>(0.08, 0.04, 0.4)).eval();
      sequence.orders.col(i) = orders;
      const surefoot::Vec<3> moved = surefoot::cycle_displacement(model, orders, previous).vec();
      pose = pose * surefoot::Pose2::from_vec(moved + noise.sample(orders, previous, rng));
      sequence.poses.col(i) = pose.vec();
    }
    result.push_back(sequence);
  }
  return result;
}

inline std::vector<surefoot::WalkSequence> final_poses(std::vector<surefoot::WalkSequence> sequences) {
  for (surefoot::WalkSequence& sequence : sequences) sequence = final_pose_only(sequence);
  return sequences;
}

}  // namespace toys
