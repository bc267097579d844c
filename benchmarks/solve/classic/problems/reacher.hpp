// An arm of two links in the plane that brings its tip to a target; the forests see raw angles.
#pragma once

#include <cmath>
#include <numbers>

#include "../references/sampling_mpc.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: angles [rad], their speeds [rad/s], place of the target [m]; action: torques, in units of the largest.
struct Reacher {
  static constexpr int state_dim = 6, action_dim = 2;
  static constexpr int horizon = 50;  // of 0.05 s
  static constexpr int evaluation_runs = 100;
  using State = surefoot::Vec<6>;
  using Action = surefoot::Vec<2>;

  surefoot::Box<6> state_box() const {
    constexpr double pi = std::numbers::pi;
    State half;
    half << pi, pi, 10, 10, 1, 1;
    return surefoot::Box<6>::symmetric(half);
  }
  surefoot::Box<2> action_box() const { return surefoot::Box<2>::symmetric(Action(1, 1)); }
  State initial_state(surefoot::Rng& rng) const {
    constexpr double pi = std::numbers::pi;
    const double radius = 0.9 * std::sqrt(rng.uniform()), direction = rng.uniform(-pi, pi);
    State state;
    state << rng.uniform(-pi, pi), rng.uniform(-pi, pi), 0, 0, radius * std::cos(direction),
        radius * std::sin(direction);
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    const Action unit = action_box().clamp(action);
    State next = state;
    next.head<4>() =
        runge_kutta(surefoot::Vec<4>(state.head<4>()), 0.05, [&](const surefoot::Vec<4>& s) { return rates(s, unit); });
    for (int i = 0; i < 2; ++i) next[i] = std::remainder(next[i], 2 * std::numbers::pi);
    const double x = 0.5 * (std::cos(next[0]) + std::cos(next[0] + next[1])) - next[4];
    const double y = 0.5 * (std::sin(next[0]) + std::sin(next[0] + next[1])) - next[5];
    return {next, -std::sqrt(x * x + y * y) - 0.01 * unit.squaredNorm(), false};
  }

  Reference reference() const { return mpc_reference(*this, {.horizon = 20, .samples = 200, .rounds = 4}); }

 private:
  // Rods of 1 kg and 0.5 m with viscous friction, without gravity.
  static surefoot::Vec<4> rates(const surefoot::Vec<4>& s, const Action& unit) {
    constexpr double rod = 0.25;                                                 // mass times squared length [kg m^2]
    constexpr double friction = 0.1, strongest_first = 6, strongest_second = 2;  // [N m s], [N m]
    const double cosine = std::cos(s[1]), sine = std::sin(s[1]);
    const double a = rod * (5.0 / 3 + cosine), b = rod * (1.0 / 3 + 0.5 * cosine), c = rod / 3;
    const double coriolis = 0.5 * rod * sine;
    const double first = strongest_first * unit[0] - friction * s[2] + coriolis * s[3] * (2 * s[2] + s[3]);
    const double second = strongest_second * unit[1] - friction * s[3] - coriolis * s[2] * s[2];
    const double determinant = a * c - b * b;
    return {s[2], s[3], (c * first - b * second) / determinant, (a * second - b * first) / determinant};
  }
};

static_assert(surefoot::Problem<Reacher>);

}  // namespace classic
