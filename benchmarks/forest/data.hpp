// Data of the shape the solver has: six inputs like the states of a ball approach, a value-like target with cliffs, and
// a policy-like target with three clipped outputs.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot::bench {

/// Distance and direction of the ball, direction of the target, last step (forward, sideways, turn).
inline Vec<6> random_state(Rng& rng) {
  constexpr double pi = std::numbers::pi;
  Vec<6> s;
  s << rng.uniform(0, 1), rng.uniform(-pi, pi), rng.uniform(-pi, pi), rng.uniform(-0.02, 0.04),
      rng.uniform(-0.02, 0.02), rng.uniform(-0.2, 0.2);
  return s;
}

/// One output: like a value function, with two cliffs. Three: like a policy, clipped.
template <int Outputs>
Vec<Outputs> target(const Vec<6>& s) {
  const double x = s[0] * std::cos(s[1]);
  const double y = s[0] * std::sin(s[1]);
  Vec<Outputs> out;
  if constexpr (Outputs == 1) {
    out[0] = -5 * std::abs(x - 0.22) - 4 * std::abs(y) - 3 * std::abs(s[2]) - 1.5 * std::abs(s[1]);
    if (x > -0.2 && x < 0.15 && std::abs(y) < 0.25) out[0] -= 3;
    if (s[0] > 0.95) out[0] -= 30;
  } else {
    const bool near = std::abs(s[2]) < 0.3 && s[0] < 0.5;
    const double vx = near ? 0.2 * (x - 0.22) : std::max(0.0, 0.04 * std::cos(s[1]));
    const double vy = near ? 0.18 * y : -0.05 * s[2];
    const double vt = near ? 0.2 * s[2] : 0.4 * s[1];
    out << (vx - s[3]) / 0.02, (vy - s[4]) / 0.01, (vt - s[5]) / 0.15;
    out = out.cwiseMax(-1).cwiseMin(1);
  }
  return out;
}

/// `count` random states and their targets.
template <int Outputs>
Dataset<6, Outputs> make_samples(Eigen::Index count, std::uint64_t seed) {
  Dataset<6, Outputs> samples;
  samples.inputs.resize(6, count);
  samples.outputs.resize(Outputs, count);
  Rng rng(seed);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec<6> s = random_state(rng);
    samples.inputs.col(i) = s.cast<float>();
    samples.outputs.col(i) = target<Outputs>(s);
  }
  return samples;
}

/// The share of the test set's variance that the forest explains (R2).
template <class F, int Outputs>
double explained(const F& forest, const Dataset<6, Outputs>& test) {
  Eigen::Matrix<double, Outputs, Eigen::Dynamic> predicted;
  forest.predict(test.inputs, predicted);
  const Vec<Outputs> mean = test.outputs.rowwise().mean();
  return 1 - (predicted - test.outputs).squaredNorm() / (test.outputs.colwise() - mean).squaredNorm();
}

}  // namespace surefoot::bench
