// Dubins' car: it always drives forwards, around three obstacles, to a place in minimum time.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "../references/value_iteration.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: place [m], heading [rad]; action: steering in units of the tightest curve.
struct Dubins {
  static constexpr int state_dim = 3, action_dim = 1, feature_dim = 4;
  static constexpr int horizon = 100;
  static constexpr int evaluation_runs = 1000;
  using State = surefoot::Vec<3>;
  using Action = surefoot::Vec<1>;

  surefoot::Box<3> state_box() const { return {State(-2, -2, -std::numbers::pi), State(2, 2, std::numbers::pi)}; }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1)); }
  State initial_state(surefoot::Rng& rng) const {
    return {rng.uniform(-1.5, -0.8), rng.uniform(-1, 1), rng.uniform(-std::numbers::pi, std::numbers::pi)};
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double length = 0.15, turn = 0.35;  // of a step [m], [rad]
    const double angle = turn * std::min(1.0, std::max(-1.0, action[0])), heading = state[2] + 0.5 * angle;
    const State next(state[0] + length * std::cos(heading), state[1] + length * std::sin(heading),
                     std::remainder(state[2] + angle, 2 * std::numbers::pi));
    if (hits(next)) return {next, -50, true};
    return {next, -1, std::hypot(next[0] - 1.4, next[1]) < 0.25};
  }

  surefoot::Vec<4> features(const State& s) const { return {s[0], s[1], std::cos(s[2]), std::sin(s[2])}; }

  Reference reference() const {
    return grid_reference(*this, {101, 101, 73}, {false, false, true}, {{9}}, {.discount = 1, .sweeps = 60});
  }

 private:
  bool hits(const State& s) const {
    constexpr std::array<std::array<double, 3>, 3> disks{{{0.0, 0.0, 0.45}, {0.5, 1.0, 0.4}, {0.5, -1.1, 0.4}}};
    for (const auto& [x, y, radius] : disks) {
      if (std::hypot(s[0] - x, s[1] - y) < radius) return true;
    }
    return std::abs(s[0]) > 2 || std::abs(s[1]) > 2;
  }
};

static_assert(surefoot::Problem<Dubins>);

}  // namespace classic
