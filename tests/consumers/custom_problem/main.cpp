// A problem of one's own, with a state type of one's own: a boat that must reach its jetty against wind. Fails unless
// the learnt policy beats drifting.
#include <cstdio>

#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/rfpi.hpp"

// [state]
struct Boat : surefoot::Vec<2> {
  using surefoot::Vec<2>::Vec;               // constructors
  double& distance() { return (*this)[0]; }  // from the jetty [m]
  double& speed() { return (*this)[1]; }     // away from it [m/s]
  double distance() const { return (*this)[0]; }
  double speed() const { return (*this)[1]; }
};

struct Docking {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = Boat;
  using Action = surefoot::Vec<1>;  // thrust [m/s^2]

  surefoot::Box<2> state_box() const { return surefoot::Box<2>::symmetric(Boat(5, 3)); }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1.0)); }
  Boat initial_state(surefoot::Rng& rng) const { return {rng.uniform(2, 5), 0}; }

  surefoot::Step<Boat> step(const Boat& boat, const Action& thrust, surefoot::Rng& rng) const {
    constexpr double dt = 0.2;               // [s]
    const double gust = 0.1 * rng.normal();  // [m/s^2]
    Boat next = boat;
    next.speed() += (action_box().clamp(thrust)[0] + gust - 0.3 * boat.speed()) * dt;
    next.distance() += next.speed() * dt;
    return {next, -(next.distance() * next.distance() + next.speed() * next.speed()), false};
  }
};
static_assert(surefoot::Problem<Docking>);
// [state]

int main() {
  const surefoot::Threads threads;
  const auto drift = [](const Boat&) { return Docking::Action(0.0); };
  const double drifting = -surefoot::evaluate(Docking{}, drift, {.runs = 500}, threads, /*seed*/ 1).mean;
  const auto learnt =
      surefoot::rfpi(Docking{}, {.budget = {.counted_seconds = 1}, .max_iterations = 12}, threads, /*seed*/ 1);
  std::printf("cost of drifting %.0f, of the learnt policy %.0f\n", drifting, learnt.cost.mean);
  return learnt.cost.mean < 0.5 * drifting ? 0 : 1;
}
