#include "surefoot/solve/lookahead.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/solve/forest_policy.hpp"

namespace surefoot {
namespace {

// One step whose reward is a bowl over the actions; writes down every action it meets.
struct Bowl {
  static constexpr int state_dim = 1, action_dim = 2;
  using State = Vec<1>;
  using Action = Vec<2>;

  Action best{0.3, -1.2};
  double noise = 0;      // half width, of the reward
  bool terminal = true;  // else it leads to the state 1
  std::vector<Action>* tried = nullptr;

  Box<1> state_box() const { return Box<1>::symmetric(State(1)); }
  Box<2> action_box() const { return {Action(-1, -2), Action(1, 4)}; }
  State initial_state(Rng&) const { return State(0); }
  Step<State> step(const State&, const Action& action, Rng& rng) const {
    if (tried != nullptr) tried->push_back(action);
    return {State(1), -(action - best).squaredNorm() + rng.uniform(-noise, noise), terminal};
  }
};
static_assert(Problem<Bowl>);

using Value = Forest<1, 1, ConstantLeaf>;
const Value no_value;

Value constant_value(double value) {
  const Dataset<1, 1> data{
      .inputs = Eigen::RowVector2f(-1, 1), .outputs = Eigen::RowVector2d(value, value), .weights = {}};
  return train_extra_trees<ConstantLeaf>(data, {.trees = 3}, Serial{}, 1);
}

auto look(const Bowl& problem, const LookaheadOptions& options, std::uint64_t seed = 1,
          const Bowl::Action* incumbent = nullptr, const Value& value = no_value) {
  return Lookahead<Bowl>(problem, value, 0.9, options)(Vec<1>(0), incumbent, Rng(seed));
}

// Root mean square distance from the best action over many lookaheads [m, as all actions here].
double error(const Bowl& problem, const LookaheadOptions& options) {
  const int count = 200;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed)
    sum += (look(problem, options, seed).action - problem.best).squaredNorm();
  return std::sqrt(sum / count);
}

TEST_CASE("the best action of a bowl is found, and finer with more candidates") {
  const double usual = error({}, {});
  const double more = error({}, {.candidates = 30, .kept = 8, .refined = 60});
  CHECK(usual < 0.6);
  CHECK(more < 0.25);
  CHECK(error({}, {.candidates = 100, .corners = false, .refined = 0, .softness = 0}) < 0.6);
}

TEST_CASE("an action in a corner or on an edge of the box is found exactly or on it") {
  Bowl problem{.best = Vec<2>(1, 4)};
  CHECK(look(problem, {.softness = 0}).action == problem.best);
  problem.best = Vec<2>(5, 1);  // beyond the box
  const LookaheadOptions many{.candidates = 60, .refined = 60, .softness = 0};
  CHECK(look(problem, many).action[0] == 1);
}

TEST_CASE("corners, centre and incumbent are always tried") {
  std::vector<Vec<2>> tried;
  const Bowl problem{.tried = &tried};
  const Vec<2> incumbent(0.125, 0.5);
  look(problem, {.samples = 1, .refined = 0}, 1, &incumbent);
  CHECK(tried.size() == 11);
  for (const Vec<2>& wanted : {incumbent, Vec<2>(0, 1), Vec<2>(-1, -2), Vec<2>(1, -2), Vec<2>(-1, 4), Vec<2>(1, 4)}) {
    CHECK(std::ranges::count(tried, wanted) == 1);
  }
}

TEST_CASE("an incumbent that is the best stays the best") {
  Bowl problem;
  problem.best = Vec<2>(0.125, 0.5);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CHECK(look(problem, {.softness = 0}, seed, &problem.best).action == problem.best);
  }
}

TEST_CASE("without softness the action is one that was tried, with softness it is a mean and closer to the best") {
  std::vector<Vec<2>> tried;
  const Bowl problem{.tried = &tried};
  const auto hard = look(problem, {.softness = 0});
  CHECK(std::ranges::count(tried, hard.action) > 0);
  for (const Vec<2>& action : tried) CHECK((action - problem.best).norm() >= (hard.action - problem.best).norm());
  CHECK(hard.value == doctest::Approx(-(hard.action - problem.best).squaredNorm()));
  tried.clear();
  const auto soft = look(problem, {});
  CHECK(std::ranges::count(tried, soft.action) == 0);
  CHECK(problem.action_box().contains(soft.action));
  CHECK(soft.value <= hard.value);
  const Bowl noisy{.noise = 1};
  CHECK(error(noisy, {}) < error(noisy, {.softness = 0}));
}

TEST_CASE("noise that all candidates have in common cancels out") {
  const Bowl noisy{.noise = 10};
  const LookaheadOptions common{.softness = 0};
  const LookaheadOptions independent{.common_noise = false, .softness = 0};
  CHECK(error(noisy, common) == doctest::Approx(error({}, common)));
  CHECK(error(noisy, independent) > 1.5 * error(noisy, common));
}

TEST_CASE("evenly spread noise makes values far less noisy") {
  const Bowl noisy{.noise = 1};
  const auto spread = [&](bool common) {
    double squares = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const LookaheadOptions options{
          .candidates = 6, .samples = 10, .common_noise = common, .refined = 0, .softness = 0};
      const auto found = look(noisy, options, seed);
      squares += std::pow(found.value + (found.action - noisy.best).squaredNorm(), 2);
    }
    return squares / 200;
  };
  CHECK(spread(true) < 0.1 * spread(false));
}

TEST_CASE("what follows counts with its discounted value, but nothing follows a terminal step") {
  const Value value = constant_value(50);
  const LookaheadOptions options{.softness = 0};
  const double alone = look({}, options).value;
  CHECK(look({}, options, 1, nullptr, value).value == alone);
  CHECK(look({.terminal = false}, options, 1, nullptr, value).value == doctest::Approx(alone + 0.9 * 50));
  CHECK(look({.terminal = false}, options).value == alone);  // an empty forest counts as 0
}

TEST_CASE("equal random numbers give equal results, whatever was looked at before") {
  const Bowl noisy{.noise = 1};
  const LookaheadOptions options;
  Lookahead<Bowl> reused(noisy, no_value, 0.9, options);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto fresh = look(noisy, options, seed);
    const auto again = reused(Vec<1>(0), nullptr, Rng(seed));
    CHECK(fresh.action == again.action);
    CHECK(fresh.value == again.value);
  }
  CHECK(look(noisy, options, 1).action != look(noisy, options, 2).action);
}

TEST_CASE("as many transitions are simulated as it says") {
  const Vec<2> incumbent(0, 0);
  for (const LookaheadOptions& options :
       {LookaheadOptions{}, LookaheadOptions{.candidates = 1, .refined = 0}, LookaheadOptions{.kept = 9, .refined = 4},
        LookaheadOptions{.candidates = 2, .kept = 6, .refined = 12},
        LookaheadOptions{.corners = false, .common_noise = false}}) {
    std::vector<Vec<2>> tried;
    const Bowl problem{.tried = &tried};
    Lookahead<Bowl> lookahead(problem, no_value, 0.9, options);
    lookahead(Vec<1>(0), &incumbent, Rng(1));
    CHECK(tried.size() == lookahead.transitions());
    for (const Vec<2>& action : tried) CHECK(problem.action_box().contains(action));
  }
}

// Twelve motors that had better stand still, but for the first.
struct ManyMotors {
  static constexpr int state_dim = 1, action_dim = 12;
  using State = Vec<1>;
  using Action = Vec<12>;
  Box<1> state_box() const { return Box<1>::symmetric(State(1)); }
  Box<12> action_box() const { return Box<12>::symmetric(Action::Ones()); }
  State initial_state(Rng&) const { return State(0); }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    return {state, action[0] - action.tail<11>().squaredNorm(), true};
  }
};

TEST_CASE("many action dimensions have too many corners to try, and still the action is better than the centre") {
  const ManyMotors problem;
  const LookaheadOptions options{.candidates = 40, .refined = 400, .step = 0.2, .softness = 0};
  const auto found = Lookahead<ManyMotors>(problem, no_value, 1, options)(Vec<1>(0), nullptr, Rng(1));
  CHECK(found.value > 0.05);  // the centre gives 0
}

TEST_CASE("a motor that is locked gets its only action") {
  struct Locked : Bowl {
    Box<2> action_box() const { return {Action(0.5, -2), Action(0.5, 4)}; }
  };
  const Locked problem;
  const LookaheadOptions options;
  const Vec<2> incumbent(0.5, 0);
  CHECK(Lookahead<Locked>(problem, no_value, 1, options)(Vec<1>(0), &incumbent, Rng(1)).action[0] == 0.5);
}

TEST_CASE("a reward that is no number is refused in words") {
  struct Broken : Bowl {
    Step<State> step(const State& state, const Action&, Rng&) const {
      return {state, std::numeric_limits<double>::quiet_NaN(), false};
    }
  };
  const Broken problem;
  const LookaheadOptions options;
  Lookahead<Broken> lookahead(problem, no_value, 1, options);
  CHECK_THROWS_WITH_AS(lookahead(Vec<1>(0), nullptr, Rng(1)), doctest::Contains("not finite"), SolveError);
}

// A point that an action moves; its distance from 0 costs when the next action is taken.
struct Point {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = Vec<1>;
  using Action = Vec<1>;

  Box<1> state_box() const { return Box<1>::symmetric(State(1)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1)); }
  State initial_state(Rng&) const { return State(0); }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    return {state + action, -state.squaredNorm(), false};
  }
};

TEST_CASE("a lookahead that follows the policy sees what comes after its action") {
  const Dataset<1, 1> still{.inputs = Eigen::RowVector2f(-1, 1), .outputs = Eigen::RowVector2d(0, 0), .weights = {}};
  const ForestPolicy<Point> policy(Point{}, train_extra_trees<LinearLeaf>(still, {.trees = 1}, Serial{}, 1));
  const LookaheadOptions options{.samples = 1, .refined = 40, .refined_samples = 1, .softness = 0, .follow = 2};
  const Vec<1> start(0.6);
  const Point problem;
  Lookahead<Point> follows(problem, no_value, 0.5, options, &policy);
  const auto found = follows(start, nullptr, Rng(1));
  CHECK(found.action[0] == doctest::Approx(-0.6).epsilon(0.1));
  const double left = std::pow(0.6 + found.action[0], 2);
  CHECK(found.value == doctest::Approx(-0.36 - 0.75 * left));  // discounts of 0.5 and 0.25
  CHECK(follows.transitions() == 3 * (11 + 40));
  CHECK(follows.policy_actions() == 2 * (11 + 40));

  Lookahead<Point> alone(problem, no_value, 0.5, options);
  CHECK(alone(start, nullptr, Rng(1)).value == doctest::Approx(-0.36));
  CHECK(alone.policy_actions() == 0);
}

}  // namespace
}  // namespace surefoot
