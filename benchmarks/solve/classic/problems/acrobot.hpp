// Acrobot-v1 of Gymnasium with a continuous torque: two links that hang, a motor between them, up as fast as possible.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../references/reference.hpp"
#include "integrate.hpp"
#include "surefoot/core/problem.hpp"

namespace classic {

/// State: angles of the two links (0, 0 hangs) [rad], their speeds; action: torque [N m].
struct Acrobot {
  static constexpr int state_dim = 4, action_dim = 1, feature_dim = 6;
  static constexpr int horizon = 500;  // of 0.2 s
  static constexpr int evaluation_runs = 200;
  using State = surefoot::Vec<4>;
  using Action = surefoot::Vec<1>;

  surefoot::Box<4> state_box() const {
    constexpr double pi = std::numbers::pi;
    return surefoot::Box<4>::symmetric(State(pi, pi, 4 * pi, 9 * pi));
  }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1)); }
  State initial_state(surefoot::Rng& rng) const {
    return {rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1)};
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    constexpr double pi = std::numbers::pi;
    const double torque = std::clamp(action[0], -1.0, 1.0);
    State next = runge_kutta(state, 0.2, [&](const State& s) { return rates(s, torque); });
    for (int i = 0; i < 2; ++i) next[i] = std::remainder(next[i], 2 * pi);
    next[2] = std::clamp(next[2], -4 * pi, 4 * pi);
    next[3] = std::clamp(next[3], -9 * pi, 9 * pi);
    const bool up = -std::cos(next[0]) - std::cos(next[0] + next[1]) > 1;
    return {next, up ? 0.0 : -1.0, up};
  }

  surefoot::Vec<6> features(const State& s) const {
    surefoot::Vec<6> f;
    f << std::cos(s[0]), std::sin(s[0]), std::cos(s[1]), std::sin(s[1]), s[2], s[3];
    return f;
  }

  Reference reference() const {
    const auto pump = [](const State& s) { return Action(s[3] >= 0 ? 1 : -1); };
    return {evaluated(*this, pump), "energy: full torque along the speed of the joint"};
  }

 private:
  // Links of 1 kg and 1 m, centres of mass in the middle, moments of inertia 1 (Sutton and Barto).
  static State rates(const State& s, double torque) {
    constexpr double gravity = 9.8;
    const double cosine = std::cos(s[1]), sine = std::sin(s[1]);
    const double d1 = 0.25 + (1.25 + cosine) + 2;
    const double d2 = 0.25 + 0.5 * cosine + 1;
    const double phi2 = 0.5 * gravity * std::sin(s[0] + s[1]);
    const double phi1 = -0.5 * s[3] * s[3] * sine - s[3] * s[2] * sine + 1.5 * gravity * std::sin(s[0]) + phi2;
    const double second = (torque + d2 / d1 * phi1 - 0.5 * s[2] * s[2] * sine - phi2) / (1.25 - d2 * d2 / d1);
    return {s[2], s[3], -(d2 * second + phi1) / d1, second};
  }
};

static_assert(surefoot::Problem<Acrobot>);

}  // namespace classic
