// Masses in a row between springs, with a force on the first and on the last: the optimum is known exactly.
#pragma once

#include <algorithm>

#include "../references/riccati.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: positions [m], then speeds; action: forces [N].
template <int Masses>
struct Chain {
  static constexpr int state_dim = 2 * Masses, action_dim = Masses > 1 ? 2 : 1;
  static constexpr int horizon = 100;  // of 0.1 s
  static constexpr int evaluation_runs = 500;
  using State = surefoot::Vec<state_dim>;
  using Action = surefoot::Vec<action_dim>;

  surefoot::Box<state_dim> state_box() const { return surefoot::Box<state_dim>::symmetric(State::Constant(1.5)); }
  surefoot::Box<action_dim> action_box() const { return surefoot::Box<action_dim>::symmetric(Action::Constant(3)); }
  State initial_state(surefoot::Rng& rng) const {
    State state;
    for (int i = 0; i < state_dim; ++i) state[i] = i < Masses ? rng.uniform(-1, 1) : rng.uniform(-0.5, 0.5);
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    const Action force = action_box().clamp(action);
    const State next = runge_kutta(state, 0.1, [&](const State& s) {
      State rates;
      for (int i = 0; i < Masses; ++i) {
        const double left = i > 0 ? s[i - 1] : 0.0, right = i + 1 < Masses ? s[i + 1] : 0.0;
        rates[i] = s[Masses + i];
        rates[Masses + i] = left + right - 2 * s[i] - 0.1 * s[Masses + i];
      }
      rates[Masses] += force[0];
      if constexpr (Masses > 1) rates[state_dim - 1] += force[1];
      return rates;
    });
    return {next, -(state.dot(stage_cost() * state) + action_cost() * force.squaredNorm()), false};
  }

  static Eigen::Matrix<double, state_dim, state_dim> stage_cost() {
    State weights;
    for (int i = 0; i < state_dim; ++i) weights[i] = i < Masses ? 0.1 : 0.01;
    return weights.asDiagonal();
  }
  static constexpr double action_cost() { return 0.01; }

  Reference reference() const { return linear_reference(*this, stage_cost(), action_cost(), "Riccati, exact"); }
};

using Chain2 = Chain<1>;
using Chain4 = Chain<2>;
using Chain6 = Chain<3>;
using Chain8 = Chain<4>;
using Chain12 = Chain<6>;

static_assert(surefoot::Problem<Chain2> && surefoot::Problem<Chain12>);

}  // namespace classic
