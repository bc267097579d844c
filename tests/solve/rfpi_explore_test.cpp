#include "surefoot/solve/rfpi_explore.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"

namespace surefoot::detail {
namespace {

/// A run that random actions end: it falls, or reaches its goal, once the action was off the policy's so many times.
struct Tightrope {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = Vec<1>;
  using Action = Vec<1>;
  int missteps = 1;  // that end a run

  Box<1> state_box() const { return {State(0), State(1000)}; }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1)); }
  State initial_state(Rng&) const { return State(0); }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    const State next(state[0] + (action[0] == 0 ? 0 : 1));
    return {next, -1, next[0] >= missteps};
  }
};
static_assert(Problem<Tightrope>);

std::vector<Vec<1>> still(std::span<const Vec<1>> states) { return std::vector<Vec<1>>(states.size(), Vec<1>(0)); }

double explored(const Tightrope& problem, double length, RfpiWork& work) {
  return survived_exploration(problem, still, 4, 0.3, length, 200, Threads(2), Rng(1), work, {});
}

TEST_CASE("runs explore as asked for where they last") {
  RfpiWork work;
  CHECK(explored({.missteps = 1000}, 200, work) == 0.3);
  CHECK(work.steps == 32 * 200);
  CHECK(work.lookups == 4 * work.steps);
}

TEST_CASE("runs explore less where that would soon end them") {
  RfpiWork work;
  // With 0.3 / 1.41^i a share of 2 / (2 + (1 - chance) / chance) of the steps is random, one each ends a run.
  CHECK(explored({.missteps = 1}, 200, work) == doctest::Approx(0.3 / std::pow(1.41, 6)));
  CHECK(explored({.missteps = 20}, 200, work) == doctest::Approx(0.3 / std::pow(1.41, 3)));  // after 76, 103 steps
  CHECK(explored({.missteps = 20}, 100, work) == 0.3);
}

TEST_CASE("runs of a policy that soon ends them itself explore as asked for") {
  RfpiWork work;
  CHECK(explored({.missteps = 1}, 4, work) == 0.3);
}

}  // namespace
}  // namespace surefoot::detail
