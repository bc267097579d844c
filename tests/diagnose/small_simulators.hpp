// Simulators small enough to be solved on paper, for the tests of single parts of the diagnosis.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace toys {

/// A block on a line, pushed by a force [N]; mass 2 kg, and a damper and a spring that are off (0) unless asked for.
struct SlidingBlock {
  using State = surefoot::Vec<2>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<2>;

  surefoot::SimulatorInfo info() const {
    return {.name = "block",
            .states = {{"x", "m"}, {"v", "m/s", "N"}},
            .inputs = {{"push", "N"}},
            .outputs = {{"x_m", "m"}, {"v_mps", "m/s"}},
            .parameters = {
                {"mass", "kg", 2, 1, 4}, {"damping", "N s/m", 0, 0, 10, true}, {"stiffness", "N/m", 0, 0, 100, true}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[1] - p[2] * x[0]) / p[0]};
  }
  State effort(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& p) const { return {1, p[0]}; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
static_assert(surefoot::Simulator<SlidingBlock>);

/// A level that is filled and leaks: x' = gain * u - leak * x, with the inflow as a signal.
struct LeakyTank {
  using State = surefoot::Vec<1>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<1>;

  surefoot::SimulatorInfo info() const {
    return {.name = "tank",
            .states = {{"level", "m"}},
            .inputs = {{"valve", "1"}},
            .outputs = {{"level_m", "m"}},
            .parameters = {{"gain", "m/s", 1, 0.2, 5}, {"leak", "1/s", 1, 0.2, 5}},
            .signals = {"inflow"}};
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p, Tap&& tap) const {
    return State(tap(0, p[0] * u[0]) - p[1] * x[0]);
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return derivative(x, u, p, surefoot::NoTap{});
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
static_assert(surefoot::Simulator<LeakyTank>);

/// Rows at equal intervals [s], inputs and outputs 0, initial state 0 and known.
inline surefoot::Recording blank_recording(const surefoot::SimulatorInfo& info, Eigen::Index rows, double interval) {
  surefoot::Recording recording;
  recording.name = "blank";
  recording.time.setLinSpaced(rows, 0, interval * static_cast<double>(rows - 1));
  recording.inputs.setZero(static_cast<Eigen::Index>(info.inputs.size()), rows);
  recording.outputs.setZero(static_cast<Eigen::Index>(info.outputs.size()), rows);
  recording.initial.setZero(static_cast<Eigen::Index>(info.states.size()));
  recording.initial_scale = recording.initial;
  return recording;
}

/// A valve that is opened and closed once a second, other than in recordings of another number.
inline surefoot::Recording tank_recording(int number, Eigen::Index rows) {
  surefoot::Recording recording = blank_recording(LeakyTank{}.info(), rows, 0.05);
  recording.name = "tank " + std::to_string(number);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = recording.time[i];
    recording.inputs(0, i) = (std::fmod(t, 1.0) < 0.5 ? 1.0 : -0.4) + 0.3 * std::sin((1 + 0.37 * number) * t);
  }
  return recording;
}

/// Nominal or other parameters, effects, and how to integrate.
inline surefoot::Augmented machine(std::vector<double> parameters, std::vector<surefoot::NamedEffect> effects = {},
                                   surefoot::Integration integration = {}) {
  surefoot::Augmented result;
  result.parameters = std::move(parameters);
  result.effects = std::move(effects);
  result.integration = integration;
  return result;
}

}  // namespace toys
