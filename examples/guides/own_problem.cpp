// A problem of your own, from the struct to the C file: a cart on a rail must come to rest in the middle, and must not
// hit the ends. Exits with 1 unless the learnt policy is better than no control and than one tuned by hand.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "surefoot/solve.hpp"

using namespace surefoot;

// [problem]
struct Cart {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = Vec<2>;   // position from the middle [m], speed [m/s]
  using Action = Vec<1>;  // force of the motor [N]

  Box<2> state_box() const { return Box<2>::symmetric(State(rail, 2)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1)); }
  State initial_state(Rng& rng) const { return {rng.uniform(-0.8, 0.8), rng.uniform(-0.5, 0.5)}; }

  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    constexpr double dt = 0.05;                             // [s]
    const double force = action_box().clamp(action)[0];     // never trust an action to keep its bounds
    const double gust = 0.3 * rng.normal();                 // [N], other in each step; all randomness is from rng
    const double friction = 0.2 * std::tanh(50 * state[1])  // [N], of the wheels
                            + 0.1 * state[1];
    const double speed = state[1] + (force + gust - friction) / mass * dt;
    const double position = state[0] + speed * dt;
    if (std::abs(position) > rail) return {State(position, speed), -100, true};  // hit an end: the run is over
    return {State(position, speed), -(position * position + 0.01 * force * force), false};
  }

  double rail = 1;  // half of its length [m]
  double mass = 1;  // [kg]
};
static_assert(Problem<Cart>);
// [problem]

int main() {
  // [validate]
  const Cart cart;
  const std::vector<std::string> complaints = validate(cart);
  for (const std::string& complaint : complaints) std::printf("%s\n", complaint.c_str());
  // [validate]

  // [evaluate]
  const auto still = [](const Cart::State&) { return Cart::Action(0); };
  const auto by_hand = [](const Cart::State& s) { return Cart::Action(std::clamp(-3 * s[0] - 3 * s[1], -1.0, 1.0)); };
  const RolloutOptions trials{.runs = 2000, .horizon = 100};
  const Threads threads;
  const Estimate without = evaluate(cart, still, trials, threads, /*seed*/ 1);
  const Estimate tuned = evaluate(cart, by_hand, trials, threads, /*seed*/ 1);
  // [evaluate]

  // [solve]
  const auto tell = [](const RfpiProgress& progress) {
    std::printf("iteration %2d, cost %6.2f, best %6.2f\n", progress.iteration, progress.cost, progress.best_cost);
    std::fflush(stdout);
  };
  const RfpiOptions options{
      .budget = {.counted_seconds = 4},  // counted work of one core: the same result on any machine
      .horizon = 100,                    // transitions of a simulated run, here 5 s
      .on_progress = tell};              // left out: silence
  const auto result = rfpi(cart, options, threads, /*seed*/ 1);
  for (const std::string& hint : result.hints) std::printf("hint: %s\n", hint.c_str());
  const Estimate learnt = evaluate(cart, result.policy, trials, threads, /*seed*/ 1);
  std::printf("cost: %.1f without control, %.2f by hand, %.2f learnt (+- %.2f)\n", -without.mean, -tuned.mean,
              -learnt.mean, learnt.half_width());
  // [solve]

  // [compare]
  const Estimate gain = compare(cart, result.policy, by_hand, trials, threads, /*seed*/ 2);
  std::printf("better than by hand by %.2f +- %.2f\n", gain.mean, gain.half_width());
  // [compare]

  // [look]
  struct FromTheLeft : Cart {
    State initial_state(Rng&) const { return {-0.8, 0}; }
  };
  const Estimate left = evaluate(FromTheLeft{}, result.policy, trials, threads, /*seed*/ 1);
  const Trajectory<Cart> path = trajectory(cart, result.policy, Cart::State(-0.8, 0), 100, Rng(1));
  std::printf("from the left: %.2f +- %.2f; one such run is at %.3f m after 2 s, at %.3f m after 5 s\n", -left.mean,
              left.half_width(), path.states[40][0], path.states.back()[0]);
  // [look]

  // [keep]
  save_policy("cart.policy", result.policy);
  const auto loaded = load_policy(cart, "cart.policy");  // called like result.policy, and gives the same bits
  const std::string c_code = export_c(result.policy, {.function = "cart_force"});
  std::ofstream("cart_force.c") << c_code;  // void cart_force(const double in[2], double out[1])
  // [keep]
  const bool same = loaded(Cart::State(0.3, 0.1)) == result.policy(Cart::State(0.3, 0.1));
  return same && complaints.empty() && learnt.mean > without.mean && gain.low() > 0 ? 0 : 1;
}
