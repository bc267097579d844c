// A solver of your own: fitted value iteration. Learns the value of a state by a regression forest, and acts by looking
// one step ahead on it (Ernst, Geurts, Wehenkel: "Tree-based batch mode reinforcement learning", JMLR 6, 2005, with
// values in place of action values). Exits with 1 unless it swings a pendulum up, with the same bits on one thread and
// on three.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stop_token>
#include <utility>

#include "surefoot/solve.hpp"

using namespace surefoot;

// [options]
struct ValueIterationOptions {
  int states = 2000;       // sampled from the state box, other ones in each iteration
  int iterations = 60;     // each looks one step further ahead
  int actions = 5;         // tried along each dimension of the action box
  int samples = 2;         // simulated transitions of each action
  double discount = 0.97;  // per transition
  ExtraTreesOptions forest = {.trees = 10, .min_leaf = 4};
};
// [options]

// [policy]
/// The best action by one simulated step and the value of where it leads. No memory: it conforms to Policy.
template <Problem P>
struct LookaheadPolicy {
  using ValueForest = Forest<feature_dim<P>(), 1>;

  P problem;
  ValueForest value = {};  // empty: nothing follows
  ValueIterationOptions options = {};

  typename P::Action operator()(const typename P::State& state) const { return best(state, Rng(0)).first; }

  /// The best action and its value, by transitions with random numbers from `rng`.
  std::pair<typename P::Action, double> best(const typename P::State& state, const Rng& rng) const {
    std::pair<typename P::Action, double> found{problem.action_box().center(),
                                                -std::numeric_limits<double>::infinity()};
    int count = 1;
    for (int k = 0; k < P::action_dim; ++k) count *= options.actions;
    for (int number = 0; number < count; ++number) {
      Vec<P::action_dim> unit;
      for (int k = 0, rest = number; k < P::action_dim; ++k, rest /= options.actions) {
        unit[k] = static_cast<double>(rest % options.actions) / (options.actions - 1);
      }
      const typename P::Action action = problem.action_box().from_unit(unit);
      double sum = 0;
      for (int i = 0; i < options.samples; ++i) {
        Rng noise = rng.stream(static_cast<std::uint64_t>(i));  // the same for every action: they differ by merit
        const auto step = problem.step(state, action, noise);
        sum += step.reward;
        if (!step.terminal && !value.empty()) {
          sum += options.discount * value.predict(features(problem, step.next))[0];
        }
      }
      if (sum / options.samples > found.second) found = {action, sum / options.samples};
    }
    return found;
  }
};
// [policy]

// [solver]
/// Same seed, same bits on any executor: job i draws from its own stream, and results are used in their order.
template <Problem P, Executor E>
LookaheadPolicy<P> value_iteration(const P& problem, const ValueIterationOptions& options, const E& executor,
                                   std::uint64_t seed, std::stop_token stop = {}) {
  LookaheadPolicy<P> policy{.problem = problem, .options = options};
  for (int iteration = 0; iteration < options.iterations && !stop.stop_requested(); ++iteration) {
    struct Sample {
      Vec<feature_dim<P>()> features;
      double value;
    };
    const auto samples = map(executor, static_cast<std::size_t>(options.states), [&](std::size_t i) {
      Rng rng(seed, static_cast<std::uint64_t>(iteration), i);
      const typename P::State state = problem.state_box().sample(rng);
      return Sample{features(problem, state), policy.best(state, rng.stream(1)).second};
    });
    Dataset<feature_dim<P>(), 1> data;
    data.inputs.resize(Eigen::NoChange, options.states);
    data.outputs.resize(Eigen::NoChange, options.states);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      data.inputs.col(static_cast<Eigen::Index>(i)) = samples[i].features.template cast<float>();
      data.outputs(0, static_cast<Eigen::Index>(i)) = samples[i].value;
    }
    policy.value = train_extra_trees(data, options.forest, executor, Rng(seed, iteration).bits());
  }
  return policy;
}

/// For a type that is not a Problem: one compile error that names the missing member.
template <class P>
  requires(!Problem<P>)
auto value_iteration(const P&, const ValueIterationOptions&, auto&&...) {
  return explain_problem<P>();
}
// [solver]

namespace {

// Swings up by a motor too weak to lift it at once.
struct Pendulum {
  static constexpr int state_dim = 2, action_dim = 1, feature_dim = 3;
  using State = Vec<2>;   // angle from upright [rad], speed [rad/s]
  using Action = Vec<1>;  // torque [N m]

  Box<2> state_box() const { return Box<2>::symmetric(State(std::numbers::pi, 8)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(2)); }
  State initial_state(Rng& rng) const { return {std::numbers::pi + rng.uniform(-0.1, 0.1), 0}; }  // hangs down
  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    constexpr double dt = 0.05;  // [s]
    const double torque = action_box().clamp(action)[0] + 0.1 * rng.normal();
    const double speed = std::clamp(state[1] + (15 * std::sin(state[0]) + 3 * torque) * dt, -8.0, 8.0);
    const double angle = std::remainder(state[0] + speed * dt, 2 * std::numbers::pi);
    return {State(angle, speed), -(angle * angle + 0.1 * speed * speed), false};
  }
  Vec<3> features(const State& state) const { return {std::cos(state[0]), std::sin(state[0]), state[1]}; }
};
static_assert(Policy<LookaheadPolicy<Pendulum>, Pendulum>);

}  // namespace

int main() {
  // [use]
  const Pendulum pendulum;
  const auto policy = value_iteration(pendulum, {}, Threads{}, /*seed*/ 1);
  const RolloutOptions trials{.runs = 200, .horizon = 200};
  const auto still = [](const Pendulum::State&) { return Pendulum::Action(0); };
  const Estimate without = evaluate(pendulum, still, trials, Threads{}, /*seed*/ 1);
  const Estimate learnt = evaluate(pendulum, policy, trials, Threads{}, /*seed*/ 1);
  std::printf("cost: %.0f without control, %.0f by value iteration\n", -without.mean, -learnt.mean);
  // [use]

  // [same_bits]
  const ValueIterationOptions few{.states = 300, .iterations = 3};
  const auto one = value_iteration(pendulum, few, Serial{}, /*seed*/ 7);
  const auto three = value_iteration(pendulum, few, Threads{3}, /*seed*/ 7);
  const bool same = one.value == three.value;
  // [same_bits]

  // It stands at the end of every run.
  int standing = 0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    const auto states = trajectory(pendulum, policy, Pendulum::State(std::numbers::pi, 0), 200, Rng(2, run)).states;
    standing += std::abs(states.back()[0]) < 0.3 ? 1 : 0;
  }
  std::printf("stands upright after 10 s in %d of 20 runs; %s bits on one thread and on three\n", standing,
              same ? "the same" : "other");
  return same && standing >= 18 && learnt.mean > 0.5 * without.mean ? 0 : 1;
}
