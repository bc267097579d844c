// A mass on a spring and a recording of ten swings, for tests of fits with many valleys.
#pragma once

#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {

/// A mass on a spring, let go: with the wrong stiffness whole swings fit again, but not as well.
struct Swing {
  using State = Vec<2>;
  using Input = Vec<0>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "swing",
            .states = {{"x", "m"}, {"v", "m/s"}},
            .inputs = {},
            .outputs = {{"x_m", "m"}},
            .parameters = {{"stiffness", "1/s^2", 4, 0.5, 50}, {"rest", "m", 0, -1, 1}}};
  }
  State derivative(const State& x, const Input& /*u*/, const Eigen::VectorXd& p) const {
    return {x[1], -p[0] * (x[0] - p[1])};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

inline BoundSimulator swing() {
  Recording recording = toys::blank_recording(Swing{}.info(), 200, 0.05);
  recording.initial[0] = 1;
  recording.outputs = simulate_augmented(Swing{}, toys::machine({4, 0.1}), recording).outputs;
  return bind_simulator(Swing{}, {recording});
}

}  // namespace surefoot::diagnosis
