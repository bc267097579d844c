// A problem of your own, solved: swing up a pendulum with a motor too weak to lift it at once.
// [readme]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "surefoot/solve.hpp"

struct Pendulum {
  static constexpr int state_dim = 2, action_dim = 1, feature_dim = 3;
  using State = surefoot::Vec<2>;   // angle from upright [rad], speed [rad/s]
  using Action = surefoot::Vec<1>;  // torque [N m]

  surefoot::Box<2> state_box() const { return surefoot::Box<2>::symmetric(State(std::numbers::pi, 8)); }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(2.0)); }
  State initial_state(surefoot::Rng& rng) const {
    return State(rng.uniform(-std::numbers::pi, std::numbers::pi), rng.uniform(-1, 1));
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng& rng) const {
    constexpr double dt = 0.05;  // [s]
    const double torque = action_box().clamp(action)[0] + 0.1 * rng.normal();
    const double speed = std::clamp(state[1] + (15 * std::sin(state[0]) + 3 * torque) * dt, -8.0, 8.0);
    const double angle = std::remainder(state[0] + speed * dt, 2 * std::numbers::pi);
    return {State(angle, speed), -(angle * angle + 0.1 * speed * speed), false};
  }

  // Optional: what regression sees, here without the jump of the angle from pi to -pi.
  surefoot::Vec<3> features(const State& state) const { return {std::cos(state[0]), std::sin(state[0]), state[1]}; }
};
static_assert(surefoot::Problem<Pendulum>);

int main() {
  const Pendulum pendulum;
  for (const auto& complaint : surefoot::validate(pendulum)) std::printf("%s\n", complaint.c_str());

  const surefoot::Threads threads;
  const auto still = [](const Pendulum::State&) { return Pendulum::Action(0.0); };
  const surefoot::RolloutOptions trials{.runs = 1000, .horizon = 200};
  std::printf("cost without control: %.0f\n", -surefoot::evaluate(pendulum, still, trials, threads, /*seed*/ 1).mean);

  // [solve]
  const auto result =
      surefoot::rfpi(pendulum, {.budget = {.counted_seconds = 10}, .horizon = 200}, threads, /*seed*/ 1);
  const auto learnt = surefoot::evaluate(pendulum, result.policy, trials, threads, /*seed*/ 1);
  std::printf("cost of the learnt policy: %.0f +- %.0f\n", -learnt.mean, learnt.half_width());
  // [solve]
}
// [readme]
