// A problem of one's own: a boat that must reach its jetty against wind. Its state is a struct with names; the library
// sees the vector that it converts to and from. Fails unless the learnt policy beats drifting.
#include <cstdio>

#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/rfpi.hpp"

struct Boat {
  double distance = 0;  // from the jetty [m]
  double speed = 0;     // away from it [m/s]

  Boat() = default;
  explicit Boat(const surefoot::Vec<2>& v) : distance(v[0]), speed(v[1]) {}
  surefoot::Vec<2> vector() const { return {distance, speed}; }

  Boat after(double thrust, double gust, double seconds) const {  // accelerations [m/s^2]
    Boat next = *this;
    next.speed += (thrust + gust - 0.3 * speed) * seconds;
    next.distance += next.speed * seconds;
    return next;
  }
};

struct Docking {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = surefoot::Vec<2>;   // of a Boat
  using Action = surefoot::Vec<1>;  // thrust [m/s^2]
  surefoot::Box<2> state_box() const { return surefoot::Box<2>::symmetric(State(5, 3)); }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(1.0)); }
  State initial_state(surefoot::Rng& rng) const {
    Boat boat;
    boat.distance = rng.uniform(2, 5);
    return boat.vector();
  }
  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng& rng) const {
    const Boat next = Boat(state).after(action_box().clamp(action)[0], 0.1 * rng.normal(), 0.2);
    return {next.vector(), -(next.distance * next.distance + next.speed * next.speed), false};
  }
};
static_assert(surefoot::Problem<Docking>);

int main() {
  const surefoot::Threads threads;
  const auto drift = [](const Docking::State&) { return Docking::Action(0.0); };
  const double drifting = -surefoot::evaluate(Docking{}, drift, {.runs = 500}, threads, /*seed*/ 1).mean;
  const auto learnt = surefoot::rfpi(Docking{}, {.budget = {.seconds = 1}, .max_iterations = 12}, threads, /*seed*/ 1);
  std::printf("cost of drifting %.0f, of the learnt policy %.0f\n", drifting, learnt.cost.mean);
  return learnt.cost.mean < 0.5 * drifting ? 0 : 1;
}
