// The classic cart-pole: keep a pole upright on a cart that must stay on its track.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surefoot/core/policy.hpp"
#include "surefoot/core/problem.hpp"

namespace surefoot::toy {

/// State: cart position [m] and speed [m/s], pole angle [rad] (0 upright) and speed [rad/s]; action: force [N].
/// Dynamics of Barto, Sutton, Anderson ("Neuronlike adaptive elements that can solve difficult learning control
/// problems", IEEE Trans. SMC 1983) with its constants, but a continuous force. Reward 1 per transition of 0.02 s until
/// the pole leans by more than 12 degrees or the cart is 2.4 m away. The optimum is known: never to fail, a return of
/// `horizon`.
struct CartPole {
  static constexpr int state_dim = 4, action_dim = 1;
  using State = Vec<4>;
  using Action = Vec<1>;
  static constexpr int horizon = 500;

  Box<4> state_box() const { return Box<4>::symmetric(State(2.4, 3, 0.21, 3)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(10)); }
  State initial_state(Rng& rng) const { return Box<4>::symmetric(State::Constant(0.05)).sample(rng); }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    constexpr double gravity = 9.8, cart = 1.0, pole = 0.1, half_length = 0.5, dt = 0.02;
    constexpr double most_lean = 12 * std::numbers::pi / 180;
    const double force = std::clamp(action[0], -10.0, 10.0);
    const double sine = std::sin(state[2]);
    const double cosine = std::cos(state[2]);
    const double push = (force + pole * half_length * state[3] * state[3] * sine) / (cart + pole);
    const double pole_acceleration =
        (gravity * sine - cosine * push) / (half_length * (4.0 / 3.0 - pole * cosine * cosine / (cart + pole)));
    const double cart_acceleration = push - pole * half_length * pole_acceleration * cosine / (cart + pole);
    const State next(state[0] + dt * state[1], state[1] + dt * cart_acceleration, state[2] + dt * state[3],
                     state[3] + dt * pole_acceleration);
    return {next, 1.0, std::abs(next[0]) > 2.4 || std::abs(next[2]) > most_lean};
  }
};

/// A linear policy that never fails from the problem's own starts.
struct CartPoleBalancer {
  Vec<1> operator()(const Vec<4>& state) const {
    return Vec<1>(1.0 * state[0] + 2.0 * state[1] + 30.0 * state[2] + 5.0 * state[3]);
  }
};

static_assert(Problem<CartPole> && Policy<CartPoleBalancer, CartPole>);

}  // namespace surefoot::toy
