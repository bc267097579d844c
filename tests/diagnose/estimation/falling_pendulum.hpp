// A pendulum that may fall over to either side, for tests.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace toys {

/// The angle is 0 where the pendulum hangs; a torque swings it.
struct FallingPendulum {
  using State = surefoot::Vec<2>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<1>;

  surefoot::SimulatorInfo info() const {
    return {.name = "pendulum",
            .states = {{"angle", "rad"}, {"speed", "rad/s"}},
            .inputs = {{"torque", "1/s^2"}},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {{"weight", "1/s^2", 9, 2, 40}, {"damping", "1/s", 0.3, 0.01, 5}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], u[0] - p[0] * std::sin(x[0]) - p[1] * x[1]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

/// Readings of a pendulum of these parameters, with noise of 0.02 rad; the first one is its start.
inline void read_angles(surefoot::Recording& one, double weight, double damping, surefoot::Rng& rng) {
  constexpr double noise = 0.02;
  one.outputs = surefoot::simulate_augmented(FallingPendulum{}, toys::machine({weight, damping}), one).outputs;
  for (double& angle : one.outputs.reshaped()) angle += noise * rng.normal();
  one.initial[0] = one.outputs(0, 0);
  one.initial_scale[0] = noise;
}

/// Six recordings of eight seconds. `near_top`: they begin so near to the upper rest that it takes a second or two to
/// fall, and the noise hides the side; otherwise near the lower one.
inline std::vector<surefoot::Recording> falling_log(bool near_top, double weight, double damping) {
  constexpr double top = 3.14159265358979;
  std::vector<surefoot::Recording> log;
  surefoot::Rng rng(5);
  for (int r = 0; r < 6; ++r) {
    surefoot::Recording one = blank_recording(FallingPendulum{}.info(), 400, 0.02);
    one.name = "fall_" + std::to_string(r);
    one.initial[0] = near_top ? top + (r % 2 == 0 ? 1 : -1) * 0.004 * (1 + 0.3 * r) : 0.3;
    for (Eigen::Index i = 0; i < one.rows(); ++i) {
      one.inputs(0, i) = one.time[i] < 3 ? 0.0 : 1.5 * std::sin((1 + 0.2 * r) * one.time[i]);
    }
    read_angles(one, weight, damping, rng);
    log.push_back(std::move(one));
  }
  return log;
}

}  // namespace toys
