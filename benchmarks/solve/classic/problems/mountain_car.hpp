// MountainCarContinuous-v0 of Gymnasium: an engine too weak for the hill, a price on its use, a prize on top.
#pragma once

#include <algorithm>
#include <cmath>

#include "../references/value_iteration.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: position, speed; action: the engine.
struct MountainCar {
  static constexpr int state_dim = 2, action_dim = 1;
  static constexpr int horizon = 999;
  static constexpr int evaluation_runs = 200;
  using State = surefoot::Vec<2>;
  using Action = surefoot::Vec<1>;

  surefoot::Box<2> state_box() const { return {State(-1.2, -0.07), State(0.6, 0.07)}; }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1)); }
  State initial_state(surefoot::Rng& rng) const { return {rng.uniform(-0.6, -0.4), 0}; }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    const double engine = std::clamp(action[0], -1.0, 1.0);
    double speed = state[1] + 0.0015 * engine - 0.0025 * std::cos(3 * state[0]);
    speed = std::clamp(speed, -0.07, 0.07);
    const double position = std::clamp(state[0] + speed, -1.2, 0.6);
    if (position <= -1.2 && speed < 0) speed = 0;
    const bool arrived = position >= 0.45 && speed >= 0;
    return {State(position, speed), (arrived ? 100 : 0) - 0.1 * engine * engine, arrived};
  }

  Reference reference() const {
    return grid_reference(*this, {361, 281}, {false, false}, {{21}}, {.discount = 0.9999, .sweeps = 1500});
  }
};

static_assert(surefoot::Problem<MountainCar>);

}  // namespace classic
