// A cart that swings its pole up and keeps it there, on a rail with ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../references/sampling_mpc.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: position [m], angle [rad] (0 upright), their speeds; action: force in units of 10 N.
struct CartPole {
  static constexpr int state_dim = 4, action_dim = 1, feature_dim = 5;
  static constexpr int horizon = 100;  // of 0.05 s
  static constexpr int evaluation_runs = 100;
  using State = surefoot::Vec<4>;
  using Action = surefoot::Vec<1>;

  surefoot::Box<4> state_box() const { return surefoot::Box<4>::symmetric(State(2.4, std::numbers::pi, 5, 12)); }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1)); }
  State initial_state(surefoot::Rng& rng) const {
    return {rng.uniform(-0.5, 0.5), std::numbers::pi + rng.uniform(-0.3, 0.3), 0, 0};
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double cart = 1, pole = 0.1, half_length = 0.5, gravity = 9.81, dt = 0.05;
    const double unit = std::clamp(action[0], -1.0, 1.0);
    State next = runge_kutta(state, dt, [&](const State& s) {
      const double sine = std::sin(s[1]), cosine = std::cos(s[1]);
      const double push = (10 * unit + pole * half_length * s[3] * s[3] * sine) / (cart + pole);
      const double turn =
          (gravity * sine - cosine * push) / (half_length * (4.0 / 3 - pole * cosine * cosine / (cart + pole)));
      return State(s[2], s[3], push - pole * half_length * turn * cosine / (cart + pole), turn);
    });
    next[1] = std::remainder(next[1], 2 * std::numbers::pi);
    if (std::abs(next[0]) > 2.4) return {next, -100, true};
    return {next, -(0.5 - 0.5 * std::cos(next[1])) - 0.05 * next[0] * next[0] - 0.005 * unit * unit, false};
  }

  surefoot::Vec<5> features(const State& s) const {
    surefoot::Vec<5> f;
    f << s[0], std::cos(s[1]), std::sin(s[1]), s[2], s[3];
    return f;
  }

  Reference reference() const { return mpc_reference(*this, {.horizon = 40, .samples = 200, .rounds = 4}); }
};

static_assert(surefoot::Problem<CartPole>);

}  // namespace classic
