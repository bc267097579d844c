// One header beside this file and Eigen: runs of a policy, and a forest that learns from them. Fails unless the forest
// steers as well as what it learnt from.
#include "surefoot.hpp"

struct Tank {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = surefoot::Vec<1>;   // level above the mark [m]
  using Action = surefoot::Vec<1>;  // inflow [m/step]
  surefoot::Box<1> state_box() const { return surefoot::Box<1>::symmetric(State(1.0)); }
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(0.2)); }
  State initial_state(surefoot::Rng& rng) const { return state_box().sample(rng); }
  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng& rng) const {
    const State next = state + action_box().clamp(action) + State(0.01 * rng.uniform(-1, 1));
    return {next, -next.norm(), false};
  }
};
static_assert(surefoot::Problem<Tank>);

int main() {
  const auto valve = [](const Tank::State& level) { return Tank::Action(-0.5 * level); };
  surefoot::Dataset<1, 1> seen;
  const auto run = surefoot::trajectory(Tank{}, valve, Tank::State(1.0), 200, surefoot::Rng(1));
  const auto other = surefoot::trajectory(Tank{}, valve, Tank::State(-1.0), 200, surefoot::Rng(2));
  seen.inputs.resize(1, 400);
  seen.outputs.resize(1, 400);
  for (int i = 0; i < 400; ++i) {
    const auto& from = i < 200 ? run : other;
    seen.inputs.col(i) = from.states[static_cast<std::size_t>(i % 200)].cast<float>();
    seen.outputs.col(i) = from.actions[static_cast<std::size_t>(i % 200)];
  }
  const surefoot::Threads threads;
  const auto forest = surefoot::train_extra_trees<surefoot::LinearLeaf>(seen, {.trees = 5}, threads, /*seed*/ 1);
  const auto learnt = [&](const Tank::State& level) { return Tank::Action(forest.predict(level)); };
  const auto cost = [&](const auto& policy) {
    return -surefoot::evaluate(Tank{}, policy, {.runs = 500}, threads, /*seed*/ 3).mean;
  };
  std::printf("surefoot %d: the valve costs %.2f, the forest %.2f\n", SUREFOOT_VERSION, cost(valve), cost(learnt));
  return cost(learnt) < 1.1 * cost(valve) && cost(valve) > 0 ? 0 : 1;
}
