#include "surefoot/solve/visited_states.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "tests/support/double_integrator.hpp"

namespace surefoot {
namespace {

using toy::DoubleIntegrator;

std::vector<Vec<1>> pull_back(std::span<const Vec<2>> states) {
  std::vector<Vec<1>> actions;
  for (const Vec<2>& state : states) actions.emplace_back(-state[0] - state[1]);
  return actions;
}

TEST_CASE("every step of every run is there, in order, on the path of the policy") {
  const DoubleIntegrator problem;
  const int horizon = 10;
  for (const std::size_t runs : {1U, 31U, 32U, 33U, 100U}) {
    const auto states = visited_states(problem, pull_back, runs, horizon, 0.0, Serial{}, Rng(1));
    REQUIRE(states.size() == runs * horizon);
    for (std::size_t i = 0; i < runs; ++i) {
      Rng rng = Rng(1).stream(i);
      Vec<2> state = problem.initial_state(rng);
      for (std::size_t t = 0; t < horizon; ++t) {
        CHECK(states[i * horizon + t] == state);
        state = problem.step(state, Vec<1>(-state[0] - state[1]), rng).next;
      }
    }
  }
  CHECK(visited_states(problem, pull_back, 0, horizon, 0.0, Serial{}, Rng(1)).empty());
}

TEST_CASE("the states have the same bits on any number of threads, and others for other random numbers") {
  const DoubleIntegrator problem{.push = 0.1};
  const auto visit = [&](const auto& executor, int seed) {
    return visited_states(problem, pull_back, 200, 20, 0.3, executor, Rng(static_cast<std::uint64_t>(seed)));
  };
  const auto serial = visit(Serial{}, 1);
  CHECK(visit(Threads(2), 1) == serial);
  CHECK(visit(Threads(4), 1) == serial);
  CHECK(visit(Serial{}, 2) != serial);
}

TEST_CASE("the first runs are the same however many there are") {
  const DoubleIntegrator problem{.push = 0.1};
  const auto few = visited_states(problem, pull_back, 40, 10, 0.3, Serial{}, Rng(1));
  const auto many = visited_states(problem, pull_back, 90, 10, 0.3, Serial{}, Rng(1));
  REQUIRE(many.size() > few.size());
  CHECK(std::equal(few.begin(), few.end(), many.begin()));
}

// The state is the last action and the steps until the end.
struct Memory {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = Vec<2>;
  using Action = Vec<1>;
  double shortest = 1e9, longest = 1e9;  // [transitions] of a run

  Box<2> state_box() const { return {State(-1, 0), State(1, 100)}; }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1)); }
  State initial_state(Rng& rng) const { return {0, std::floor(rng.uniform(shortest, longest + 1))}; }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    return {State(action[0], state[1] - 1), 0, state[1] <= 1};
  }
};
static_assert(Problem<Memory>);

std::vector<Vec<1>> never_drawn(std::span<const Vec<2>> states) { return {states.size(), Vec<1>(0.25)}; }

TEST_CASE("exploration holds random actions for 1 to 3 steps, each as often, with the chance asked for") {
  const double chance = 0.3;
  const int horizon = 20'000;
  const auto states = visited_states(Memory{}, never_drawn, 3, horizon, chance, Serial{}, Rng(1));
  std::array<double, 4> holds{};
  double random_steps = 0;
  for (std::size_t i = 0; i < states.size();) {
    std::size_t end = i + 1;
    while (end < states.size() && states[end][0] == states[i][0]) ++end;
    const double action = states[i][0];
    if (action != 0.25 && i % horizon != 0) {  // the first state of a run remembers no action
      CHECK(std::abs(action) <= 1);
      REQUIRE(end - i <= 3);
      ++holds[end - i];
      random_steps += static_cast<double>(end - i);
    }
    i = end;
  }
  const double all = holds[1] + holds[2] + holds[3];
  for (std::size_t length = 1; length <= 3; ++length)
    CHECK(holds[length] / all == doctest::Approx(1.0 / 3).epsilon(0.06));
  // A hold of 2 steps on average follows (1 - chance) / chance steps of the policy on average.
  CHECK(random_steps / (3.0 * horizon) == doctest::Approx(2 / (2 + (1 - chance) / chance)).epsilon(0.05));
}

TEST_CASE("a run ends at its terminal step, the others go on") {
  const Memory problem{.shortest = 1, .longest = 20};
  const int horizon = 15;
  const auto states = visited_states(problem, never_drawn, 100, horizon, 0.3, Serial{}, Rng(3));
  std::size_t runs = 0;
  for (std::size_t i = 0; i < states.size(); ++runs) {
    const auto length = std::min<std::size_t>(horizon, static_cast<std::size_t>(states[i][1]));
    REQUIRE(i + length <= states.size());
    for (std::size_t t = 1; t < length; ++t) CHECK(states[i + t][1] == states[i][1] - static_cast<double>(t));
    i += length;
  }
  CHECK(runs == 100);
}

TEST_CASE("as many states come back as are asked for, however early runs end") {
  const int horizon = 100;
  for (const double longest : {1.0, 7.0, 1000.0}) {
    const Memory problem{.shortest = 1, .longest = longest};
    const auto some = enough_visited_states(problem, never_drawn, 2000, horizon, 0.3, Serial{}, Rng(4));
    CHECK(some.size() >= 2000);
    CHECK(some.size() < 2500);
    CHECK(enough_visited_states(problem, never_drawn, 2000, horizon, 0.3, Threads(3), Rng(4)) == some);
    CHECK(std::ranges::all_of(some, [&](const auto& state) { return state[1] >= 1 && state[1] <= longest; }));
  }
}

TEST_CASE("runs that go to their end are those that visited_states gives") {
  const DoubleIntegrator problem{.push = 0.1};
  const auto whole = visited_states(problem, pull_back, 6, 20, 0.3, Serial{}, Rng(1));
  CHECK(enough_visited_states(problem, pull_back, 101, 20, 0.3, Serial{}, Rng(1)) == whole);
}

TEST_CASE("a run may end where it leaves the state box") {
  const DoubleIntegrator problem;
  const auto away = [](std::span<const Vec<2>> states) { return std::vector<Vec<1>>(states.size(), Vec<1>(1.5)); };
  const auto all = visited_states(problem, away, 50, 30, 0.0, Serial{}, Rng(1));
  CHECK(all.size() == 50 * 30);
  const auto inside = visited_states(problem, away, 50, 30, 0.0, Serial{}, Rng(1), {}, RunEnd::state_box);
  CHECK(inside.size() > 50 * 5);
  CHECK(std::ranges::all_of(inside, [&](const auto& state) { return problem.state_box().contains(state); }));
  CHECK(std::ranges::count_if(all, [&](const auto& state) { return problem.state_box().contains(state); }) ==
        static_cast<std::ptrdiff_t>(inside.size()));
  CHECK(visited_states(problem, away, 50, 30, 0.0, Threads(3), Rng(1), {}, RunEnd::state_box) == inside);
  const auto enough = enough_visited_states(problem, away, 900, 30, 0.0, Serial{}, Rng(1), {}, RunEnd::state_box);
  CHECK(enough.size() >= 900);
}

TEST_CASE("a run that starts outside of the box ends further out only") {
  const Box<2> box({-1, 0}, {3, 0});  // the second dimension has no width
  CHECK(detail::half_widths_out<2>(box, Vec<2>(3, 7)) == 1);
  CHECK(detail::half_widths_out<2>(box, Vec<2>(-2, 0)) == doctest::Approx(1.5));
  CHECK(detail::half_widths_out<2>(box, Vec<2>(7, 0)) == doctest::Approx(3));
  struct Far : DoubleIntegrator {
    State initial_state(Rng&) const { return {6, 0}; }
  };
  const Far problem;
  const auto home = visited_states(problem, pull_back, 1, 20, 0.0, Serial{}, Rng(1), {}, RunEnd::state_box);
  CHECK(home.size() == 20);
  const auto away = [](std::span<const Vec<2>> states) { return std::vector<Vec<1>>(states.size(), Vec<1>(1.5)); };
  CHECK(visited_states(problem, away, 1, 20, 0.0, Serial{}, Rng(1), {}, RunEnd::state_box).size() == 2);
}

TEST_CASE("nothing more is simulated after a stop") {
  std::stop_source stop;
  stop.request_stop();
  CHECK(visited_states(Memory{}, never_drawn, 100, 10, 0.3, Threads(2), Rng(1), stop.get_token()).empty());
  CHECK(enough_visited_states(Memory{}, never_drawn, 100, 10, 0.3, Serial{}, Rng(1), stop.get_token()).empty());
}

}  // namespace
}  // namespace surefoot
