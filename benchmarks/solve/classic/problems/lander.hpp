// A craft that lands softly on a pad with a main engine and a side engine.
#pragma once

#include <cmath>

#include "../references/sampling_mpc.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: x, height [m], tilt [rad], their speeds; action: main engine (-1: off, 1: full), side engine.
struct Lander {
  static constexpr int state_dim = 6, action_dim = 2;
  static constexpr int horizon = 100;  // of 0.1 s
  static constexpr int evaluation_runs = 100;
  using State = surefoot::Vec<6>;
  using Action = surefoot::Vec<2>;

  surefoot::Box<6> state_box() const {
    State low, high;
    low << -3, 0, -1.2, -2.5, -3, -3;
    high << 3, 5, 1.2, 2.5, 2, 3;
    return {low, high};
  }
  surefoot::Box<2> action_box() const { return surefoot::Box<2>::symmetric(Action(1, 1)); }
  State initial_state(surefoot::Rng& rng) const {
    State state;
    state << rng.uniform(-2, 2), rng.uniform(3, 4), rng.uniform(-0.3, 0.3), rng.uniform(-0.5, 0.5), rng.uniform(-1, 0),
        0;
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double gravity = 1.6, main_engine = 4, side_engine = 2, dt = 0.1;  // [m/s^2], [rad/s^2], [s]
    const Action unit = action_box().clamp(action);
    const double thrust = 0.5 + 0.5 * unit[0];
    const State next = runge_kutta(state, dt, [&](const State& s) {
      State rates;
      rates << s.tail<3>(), -main_engine * thrust * std::sin(s[2]), main_engine * thrust * std::cos(s[2]) - gravity,
          side_engine * unit[1];
      return rates;
    });
    const double price = 0.1 + 0.1 * thrust + 0.02 * std::abs(unit[1]);
    if (std::abs(next[0]) > 4 || next[1] > 6) return {next, -100, true};
    if (next[1] > 0) return {next, -price, false};
    // On the ground: what is not a soft and upright stand on the pad costs.
    const double misses = std::abs(next[0]) + std::abs(next[2]) + 0.5 * std::hypot(next[3], next[4]);
    return {next, -price - 10 * std::min(misses, 10.0), true};
  }

  Reference reference() const { return mpc_reference(*this, {.horizon = 60, .samples = 200, .rounds = 4}); }
};

static_assert(surefoot::Problem<Lander>);

}  // namespace classic
