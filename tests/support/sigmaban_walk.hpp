// The walk of Sigmaban as Hofer and Rouxel (ICAPS 2017) calibrated it, for tests of the motion area.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"
#include "tests/support/walks.hpp"

namespace sigmaban {

using Model = surefoot::FullLinearCorrection;

inline Model model() { return toys::paper_walk(); }

/// With one of its parameters multiplied by a factor.
inline Model bent(int parameter, double factor) {
  surefoot::Vec<12> parameters = model().parameters();
  parameters[parameter] *= factor;
  return Model::from_parameters(parameters);
}

inline surefoot::MotionNoise noise(double factor = 1) {
  return surefoot::UniformNoise{factor * toys::paper_noise().half_width}.as_motion_noise();
}

/// Every command walked once.
inline std::vector<surefoot::WalkSequence> walked(const Model& model, const surefoot::MotionNoise& noise,
                                                  const std::vector<Eigen::Matrix3Xd>& commands, bool every_pose,
                                                  std::uint64_t seed) {
  surefoot::Rng rng(seed);
  std::vector<surefoot::WalkSequence> result;
  for (const Eigen::Matrix3Xd& one : commands) {
    const surefoot::WalkSequence planned = surefoot::planned_sequence(one, every_pose);
    result.push_back(surefoot::simulate_walk(model, noise, surefoot::PoseAccuracy(), planned, rng));
  }
  return result;
}

}  // namespace sigmaban
