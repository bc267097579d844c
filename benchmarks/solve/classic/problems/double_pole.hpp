// A cart that balances two poles of different length.
#pragma once

#include <array>
#include <cmath>

#include "../references/riccati.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: position [m], angles of the long and the short pole [rad], their speeds; action: force in units of 10 N.
struct DoublePole {
  static constexpr int state_dim = 6, action_dim = 1;
  static constexpr int horizon = 200;  // of 0.02 s
  static constexpr int evaluation_runs = 500;
  using State = surefoot::Vec<6>;
  using Action = surefoot::Vec<1>;

  surefoot::Box<6> state_box() const {
    State half;
    half << 2.4, 0.6, 0.6, 3, 3, 6;
    return surefoot::Box<6>::symmetric(half);
  }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1)); }
  State initial_state(surefoot::Rng& rng) const {
    State state;
    state << rng.uniform(-1, 1), rng.uniform(-0.1, 0.1), rng.uniform(-0.03, 0.03), 0, 0, 0;
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    const Action unit = action_box().clamp(action);
    const State next = runge_kutta(state, 0.02, [&](const State& s) { return rates(s, 10 * unit[0]); });
    if (std::abs(next[0]) > 2.4 || std::abs(next[1]) > 0.63 || std::abs(next[2]) > 0.63) return {next, -100, true};
    return {next, -(state.dot(stage_cost() * state) + action_cost() * unit.squaredNorm()), false};
  }

  static Eigen::Matrix<double, 6, 6> stage_cost() {
    State weights;
    weights << 0.1, 1, 1, 0.01, 0.05, 0.05;
    return weights.asDiagonal();
  }
  static constexpr double action_cost() { return 0.02; }

  Reference reference() const { return linear_reference(*this, stage_cost(), action_cost(), "LQR"); }

 private:
  // Wieland, "Evolving neural network controllers for unstable systems", IJCNN 1991, without friction.
  static State rates(const State& s, double force) {
    constexpr double gravity = 9.81, cart = 1;
    constexpr std::array<double, 2> mass{0.1, 0.01}, half_length{0.5, 0.05};
    double pushed = force, inertia = cart;
    for (int i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double sine = std::sin(s[1 + i]), cosine = std::cos(s[1 + i]);
      pushed += mass[k] * half_length[k] * s[4 + i] * s[4 + i] * sine - 0.75 * mass[k] * cosine * gravity * sine;
      inertia += mass[k] * (1 - 0.75 * cosine * cosine);
    }
    const double acceleration = pushed / inertia;
    State rates;
    rates << s.tail<3>(), acceleration, 0, 0;
    for (int i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i);
      rates[4 + i] = 0.75 / half_length[k] * (gravity * std::sin(s[1 + i]) - acceleration * std::cos(s[1 + i]));
    }
    return rates;
  }
};

static_assert(surefoot::Problem<DoublePole>);

}  // namespace classic
