// A car that parks in a gap between walls, forwards or backwards, with -1 for every step.
#pragma once

#include <cmath>
#include <numbers>

#include "../references/value_iteration.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: place of the rear axle [m], heading [rad]; action: speed [m/s], steering in units of the tightest curve.
struct Parking {
  static constexpr int state_dim = 3, action_dim = 2, feature_dim = 4;
  static constexpr int horizon = 100;
  static constexpr int evaluation_runs = 1000;
  using State = surefoot::Vec<3>;
  using Action = surefoot::Vec<2>;

  surefoot::Box<3> state_box() const { return {State(-2, -1.5, -std::numbers::pi), State(2, 1.5, std::numbers::pi)}; }
  surefoot::Box<2> action_box() const { return surefoot::Box<2>::symmetric(Action(1, 1)); }
  State initial_state(surefoot::Rng& rng) const {
    return {rng.uniform(-1.8, 1.8), rng.uniform(-1.3, 0.2), rng.uniform(-std::numbers::pi, std::numbers::pi)};
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double curvature = 1.5;  // of the tightest curve [1/m]
    constexpr double dt = 0.3;         // [s]
    const Action unit = action_box().clamp(action);
    const double turn = unit[0] * curvature * unit[1] * dt, heading = state[2] + 0.5 * turn;
    State next(state[0] + unit[0] * dt * std::cos(heading), state[1] + unit[0] * dt * std::sin(heading),
               std::remainder(state[2] + turn, 2 * std::numbers::pi));
    if (blocked(next)) next = state;  // it stands where it was
    const double off = std::abs(std::remainder(next[2] - 0.5 * std::numbers::pi, std::numbers::pi));
    return {next, -1, std::abs(next[0]) < 0.2 && next[1] > 0.9 && off < 0.2};
  }

  surefoot::Vec<4> features(const State& s) const { return {s[0], s[1], std::cos(s[2]), std::sin(s[2])}; }

  Reference reference() const {
    return grid_reference(*this, {81, 61, 73}, {false, false, true}, {{5, 7}}, {.discount = 1, .sweeps = 60});
  }

 private:
  // The gap is 0.8 m wide and goes up from y = 0.5 m.
  bool blocked(const State& s) const {
    return std::abs(s[0]) > 2 || std::abs(s[1]) > 1.5 || (s[1] > 0.5 && std::abs(s[0]) > 0.4);
  }
};

static_assert(surefoot::Problem<Parking>);

}  // namespace classic
