// The cost of standing still, and of heading for the middle, on a line where every metre away costs one per step.
#include <cstdio>

#include "surefoot/core.hpp"

struct Line {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = surefoot::Vec<1>;
  using Action = surefoot::Vec<1>;
  surefoot::Box<1> state_box() const { return surefoot::Box<1>::symmetric(State(1.0)); }    // [m]
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(0.1)); }  // [m/step]
  State initial_state(surefoot::Rng& rng) const { return state_box().sample(rng); }
  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng&) const {
    const State next = state_box().clamp(state + action_box().clamp(action));
    return {next, -next.norm(), false};
  }
};
static_assert(surefoot::Problem<Line>);

int main() {
  const auto still = [](const Line::State&) { return Line::Action(0.0); };
  const auto homing = [](const Line::State& state) { return Line::Action(-state); };
  const auto cost = [](const auto& policy) {
    return -surefoot::evaluate(Line{}, policy, {.runs = 1000}, surefoot::Threads{}, /*seed*/ 1).mean;
  };
  std::printf("standing still costs %.2f m, heading for the middle %.2f m\n", cost(still), cost(homing));
}
