// A position servo that swings a weight: the toy on which diagnoses are tested, and recordings of it made by
// simulation.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace toys {

using surefoot::Vec;

/// Orders and measured angle [rad]; voltage 12 V, gain 10 per rad, 0.5 kg at 0.15 m.
struct ServoPendulum {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  static constexpr double load = 0.5 * 0.15 * 0.15;

  surefoot::SimulatorInfo info() const {
    return {.name = "servo pendulum",
            .states = {{"theta", "rad"}, {"omega", "rad/s", "N m"}},
            .inputs = {{"goal", "rad"}},
            .outputs = {{"theta_rad", "rad"}},
            .parameters = {{"kt", "N m/A", 1.6, 0.3, 5},
                           {"R", "ohm", 3.6, 0.5, 15},
                           {"armature", "kg m^2", 0.012, 0.0005, 0.1}},
            .signals = {"duty", "tau"}};
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p, Tap&& tap) const {
    const double duty = tap(0, std::clamp(10 * (u[0] - x[0]), -1.0, 1.0));
    const double tau = tap(1, p[0] / p[1] * (12 * duty - p[0] * x[1]));
    return {x[1], (tau - 0.5 * 9.81 * 0.15 * std::sin(x[0])) / (p[2] + load)};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return derivative(x, u, p, surefoot::NoTap{});
  }
  State effort(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& p) const { return {1, p[2] + load}; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};
static_assert(surefoot::Simulator<ServoPendulum>);

/// Recordings of 3 s at 200 Hz of a machine with these effects; noise of 1 mrad, correlated from row to row.
inline std::vector<surefoot::Recording> servo_recordings(const surefoot::Augmented& machine, int count,
                                                         std::uint64_t seed) {
  std::vector<surefoot::Recording> recordings;
  surefoot::Augmented fine = machine;
  fine.integration.step = 0.001;
  for (int r = 0; r < count; ++r) {
    surefoot::Recording recording;
    recording.name = "recording " + std::to_string(r);
    constexpr Eigen::Index rows = 600;
    recording.time.setLinSpaced(rows, 0, 0.005 * (rows - 1));
    recording.inputs.resize(1, rows);
    recording.outputs.setZero(1, rows);
    recording.initial = recording.initial_scale = Vec<2>::Zero();
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = recording.time[i];
      recording.inputs(0, i) =
          r % 2 == 1 ? std::sin(t * (1 + 0.7 * r)) : (std::fmod(t, 1.4) < 0.7 ? 0.6 : -0.4) * (1 + 0.1 * r);
    }
    recording.outputs = simulate_augmented(ServoPendulum{}, fine, recording).outputs;
    surefoot::Rng rng(seed, static_cast<std::uint64_t>(r));
    double noise = 0;
    for (double& value : recording.outputs.reshaped()) {
      noise = 0.4 * noise + 0.001 * rng.normal();
      value += noise;
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

}  // namespace toys
