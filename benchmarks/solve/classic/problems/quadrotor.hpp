// A planar quadrotor that comes to rest in the origin.
#pragma once

#include <cmath>

#include "../references/riccati.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: x, z [m], tilt [rad], their speeds; action: thrust of the two rotors over that of hovering, in units of it.
struct Quadrotor {
  static constexpr int state_dim = 6, action_dim = 2;
  static constexpr int horizon = 100;  // of 0.05 s
  static constexpr int evaluation_runs = 500;
  using State = surefoot::Vec<6>;
  using Action = surefoot::Vec<2>;

  surefoot::Box<6> state_box() const {
    State half;
    half << 1.5, 1.5, 1, 2.5, 2.5, 4;
    return surefoot::Box<6>::symmetric(half);
  }
  surefoot::Box<2> action_box() const { return surefoot::Box<2>::symmetric(Action(0.8, 0.8)); }
  State initial_state(surefoot::Rng& rng) const {
    State state;
    state << rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-0.3, 0.3), 0, 0, 0;
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double gravity = 9.81, leverage = 20, dt = 0.05;  // [m/s^2], [rad/s^2 per unit], [s]
    const Action unit = action_box().clamp(action);
    const double lift = gravity * (1 + 0.5 * (unit[0] + unit[1]));
    const State next = runge_kutta(state, dt, [&](const State& s) {
      State rates;
      rates << s.tail<3>(), -lift * std::sin(s[2]), lift * std::cos(s[2]) - gravity, leverage * (unit[1] - unit[0]);
      return rates;
    });
    return {next, -(state.dot(stage_cost() * state) + action_cost() * unit.squaredNorm()), false};
  }

  static Eigen::Matrix<double, 6, 6> stage_cost() {
    State weights;
    weights << 0.05, 0.05, 0.02, 0.005, 0.005, 0.001;
    return weights.asDiagonal();
  }
  static constexpr double action_cost() { return 0.01; }

  Reference reference() const { return linear_reference(*this, stage_cost(), action_cost(), "LQR"); }
};

static_assert(surefoot::Problem<Quadrotor>);

}  // namespace classic
