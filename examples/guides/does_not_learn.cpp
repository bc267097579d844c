// A problem that is not learnt at first: a cart that gets a reward of -1 until it stands in the middle, with runs that
// end before it can be there. Exits with 1 unless the solver says so, and learns once the runs are long enough.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "surefoot/solve.hpp"

using namespace surefoot;

// [problem]
struct ParkedCart {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = Vec<2>;   // position from the middle [m], speed [m/s]
  using Action = Vec<1>;  // force on 1 kg [N]

  Box<2> state_box() const { return Box<2>::symmetric(State(1, 2)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1)); }
  State initial_state(Rng& rng) const { return {rng.uniform(-0.8, 0.8), rng.uniform(-0.5, 0.5)}; }

  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    constexpr double dt = 0.05;  // [s]
    const double force = action_box().clamp(action)[0] + 0.3 * rng.normal();
    const double speed = state[1] + force * dt, position = state[0] + speed * dt;
    const bool stands = std::abs(position) < 0.05 && std::abs(speed) < 0.1;
    return {State(position, speed), -1, stands};
  }
};
static_assert(Problem<ParkedCart>);
// [problem]

int main() {
  // [runs]
  const auto solve = [](int horizon) {
    auto result = rfpi(ParkedCart{}, {.budget = {.counted_seconds = 6}, .horizon = horizon}, Threads{}, /*seed*/ 1);
    std::printf("runs of %d transitions: cost %.1f\n", horizon, result.cost.mean);
    for (const std::string& hint : result.hints) std::printf("hint: %s\n", hint.c_str());
    return result;
  };
  const auto hurried = solve(10);   // half a second: hardly a run gets to the middle
  const auto patient = solve(100);  // 5 s
  // [runs]
  const bool told = std::ranges::any_of(hurried.hints, [](const std::string& hint) {
    return hint.find("Make the horizon (10) longer") != std::string::npos;
  });
  const bool learnt = patient.hints.empty() && patient.cost.mean < 40;
  return told && learnt ? 0 : 1;
}
