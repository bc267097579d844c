// The classic pendulum swing-up: a motor too weak to lift the pendulum at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surefoot/core/problem.hpp"

namespace surefoot::toy {

/// State: angle [rad] in [-pi, pi], 0 upright, and speed [rad/s]; action: torque [N m]. Constants, reward and starts of
/// Pendulum-v1 of Gymnasium, whose runs are 200 transitions of 0.05 s without discount.
///
/// Known mean costs of 200 transitions: 138.3 +- 1.5 for GridPolicy(pendulum, 401, 11, 200) over 10,000 runs, near the
/// optimum; 151.9 (TD3), 157.0 (SAC) and 172.2 (PPO) published with RL Baselines3 Zoo; 1224 without any torque.
struct Pendulum {
  static constexpr int state_dim = 2, action_dim = 1, feature_dim = 3;
  using State = Vec<2>;
  using Action = Vec<1>;
  static constexpr int horizon = 200;

  Box<2> state_box() const { return Box<2>::symmetric(State(std::numbers::pi, 8)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(2)); }
  State initial_state(Rng& rng) const {
    return State(rng.uniform(-std::numbers::pi, std::numbers::pi), rng.uniform(-1, 1));
  }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    constexpr double gravity = 10, length = 1, mass = 1, dt = 0.05;
    const double torque = std::clamp(action[0], -2.0, 2.0);
    const double cost = state[0] * state[0] + 0.1 * state[1] * state[1] + 0.001 * torque * torque;
    const double acceleration = 1.5 * gravity / length * std::sin(state[0]) + 3 / (mass * length * length) * torque;
    const double speed = std::clamp(state[1] + acceleration * dt, -8.0, 8.0);
    return {State(std::remainder(state[0] + speed * dt, 2 * std::numbers::pi), speed), -cost, false};
  }
  Vec<3> features(const State& state) const { return {std::cos(state[0]), std::sin(state[0]), state[1]}; }
};

static_assert(Problem<Pendulum> && HasFeatures<Pendulum>);

}  // namespace surefoot::toy
