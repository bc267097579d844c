// A mass on a line that comes to rest in the origin as fast as possible.
#pragma once

#include <algorithm>
#include <cmath>

#include "../references/value_iteration.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: position [m], speed [m/s]; action: acceleration [m/s^2].
struct MinimumTime {
  static constexpr int state_dim = 2, action_dim = 1;
  static constexpr int horizon = 100;  // of 0.1 s
  static constexpr int evaluation_runs = 1000;
  using State = surefoot::Vec<2>;
  using Action = surefoot::Vec<1>;

  surefoot::Box<2> state_box() const { return surefoot::Box<2>::symmetric(State(2.5, 2)); }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1)); }
  State initial_state(surefoot::Rng& rng) const { return {rng.uniform(-1.5, 1.5), rng.uniform(-1, 1)}; }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double dt = 0.1;
    const double a = std::clamp(action[0], -1.0, 1.0);
    const State next(state[0] + state[1] * dt + 0.5 * a * dt * dt, state[1] + a * dt);
    return {next, -1, std::abs(next[0]) < 0.05 && std::abs(next[1]) < 0.1};
  }

  Reference reference() const {
    return grid_reference(*this, {501, 401}, {false, false}, {{21}}, {.discount = 1, .sweeps = 150});
  }
};

static_assert(surefoot::Problem<MinimumTime>);

}  // namespace classic
