#include "surefoot/core/rollout.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stop_token>
#include <vector>

#include "tests/support/double_integrator.hpp"

namespace surefoot {
namespace {

using toy::DoubleIntegrator;

// Counts up from 0 and pays 1, 2, 3, ... ; ends when the count reaches `end`.
struct Staircase {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = Vec<1>;
  using Action = Vec<1>;
  double end = 1e9;
  Box<1> state_box() const { return Box<1>(State(0.0), State(100.0)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1.0)); }
  State initial_state(Rng&) const { return State(0.0); }
  Step<State> step(const State& state, const Action&, Rng&) const {
    return {State(state[0] + 1), state[0] + 1, state[0] + 1 >= end};
  }
};

// The reward is the noise of the transition, of which the action decides how much more is drawn.
struct Lottery {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = Vec<1>;
  using Action = Vec<1>;
  Box<1> state_box() const { return Box<1>(State(0.0), State(1.0)); }
  Box<1> action_box() const { return Box<1>(Action(0.0), Action(5.0)); }
  State initial_state(Rng& rng) const { return state_box().sample(rng); }
  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    const double noise = rng.normal();
    for (int i = 0; i < static_cast<int>(action[0]); ++i) rng.normal();
    return {state, state[0] + noise, false};
  }
};

template <int N>
struct Always {
  Vec<1> operator()(const Vec<1>&) const { return Vec<1>(static_cast<double>(N)); }
};

TEST_CASE("the return of a run is the discounted sum of its rewards") {
  const Always<0> policy;
  const Vec<1> start(0.0);
  CHECK(run_return(Staircase{}, policy, start, 4, 1.0, Rng(1)) == 1 + 2 + 3 + 4);
  CHECK(run_return(Staircase{}, policy, start, 3, 0.5, Rng(1)) == 1 + 0.5 * 2 + 0.25 * 3);
  CHECK(run_return(Staircase{}, policy, start, 0, 1.0, Rng(1)) == 0);
}

TEST_CASE("a run ends after its terminal transition, whose reward counts") {
  const Always<0> policy;
  CHECK(run_return(Staircase{.end = 3}, policy, Vec<1>(0.0), 100, 1.0, Rng(1)) == 1 + 2 + 3);
  const auto short_run = trajectory(Staircase{.end = 3}, policy, Vec<1>(0.0), 100, Rng(1));
  CHECK(short_run.rewards == std::vector<double>{1, 2, 3});
  CHECK(short_run.terminal);
  CHECK_FALSE(trajectory(Staircase{}, policy, Vec<1>(0.0), 100, Rng(1)).terminal);
}

TEST_CASE("a trajectory holds every state, action and reward in order") {
  const DoubleIntegrator problem{.push = 0.1};
  const toy::DoubleIntegratorOptimum policy(problem, 20);
  const auto full = trajectory(problem, policy, Vec<2>(1, 0), 20, Rng(4));
  REQUIRE(full.states.size() == 21);
  REQUIRE(full.actions.size() == 20);
  REQUIRE(full.rewards.size() == 20);
  CHECK(full.states[0] == Vec<2>(1, 0));
  double sum = 0;
  for (std::size_t t = 0; t < 20; ++t) {
    Rng noise = Rng(4).stream(t);
    const auto step = problem.step(full.states[t], full.actions[t], noise);
    CHECK(step.next == full.states[t + 1]);
    CHECK(step.reward == full.rewards[t]);
    sum += step.reward;
  }
  CHECK(sum == run_return(problem, policy, Vec<2>(1, 0), 20, 1.0, Rng(4)));
}

TEST_CASE("policies meet the same starts and noise, however much either draws") {
  const RolloutOptions options{.runs = 100, .horizon = 10};
  const auto few = returns(Lottery{}, Always<0>{}, options, Serial{}, 3);
  CHECK(few == returns(Lottery{}, Always<5>{}, options, Serial{}, 3));
  CHECK(few == returns(Lottery{}, RandomPolicy<1>(Lottery{}.action_box()), options, Serial{}, 3));
  CHECK(few != returns(Lottery{}, Always<0>{}, options, Serial{}, 4));
}

TEST_CASE("each run has its own start and noise, and does not depend on how many runs follow") {
  const auto some = returns(Lottery{}, Always<0>{}, {.runs = 70, .horizon = 3}, Serial{}, 3);
  auto more = returns(Lottery{}, Always<0>{}, {.runs = 300, .horizon = 3}, Serial{}, 3);
  for (std::size_t i = 1; i < more.size(); ++i) CHECK(more[i] != more[i - 1]);
  more.resize(70);
  CHECK(some == more);
}

TEST_CASE("a policy with memory starts every run afresh") {
  const DoubleIntegrator problem;
  const toy::DoubleIntegratorOptimum policy(problem, 30);
  const RolloutOptions options{.runs = 50, .horizon = 30};
  const auto values = returns(problem, policy, options, Serial{}, 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    Rng start = Rng(1, i).stream(0);
    CHECK(values[i] == doctest::Approx(policy.expected_return(problem.initial_state(start))));
  }
}

TEST_CASE("evaluation gives the same bits with 1, 2 and 4 threads") {
  const DoubleIntegrator problem{.push = 0.1};
  const RandomPolicy<1> policy(problem.action_box());
  const RolloutOptions options{.runs = 333, .horizon = 20};
  const Estimate serial = evaluate(problem, policy, options, Serial{}, 1);
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const Estimate parallel = evaluate(problem, policy, options, Threads(threads), 1);
    CHECK(parallel.mean == serial.mean);
    CHECK(parallel.standard_error == serial.standard_error);
  }
}

TEST_CASE("an estimate is the sample mean with its standard error") {
  const Estimate e = estimate(std::vector<double>{1, 2, 3, 6});
  CHECK(e.mean == 3);
  CHECK(e.standard_error == doctest::Approx(std::sqrt(14.0 / 3 / 4)));
  CHECK(e.runs == 4);
  CHECK(e.high() - e.low() == doctest::Approx(2 * 1.96 * e.standard_error));
  CHECK(std::isinf(estimate(std::vector<double>{1}).standard_error));
  CHECK_THROWS_AS(estimate({}), CoreError);
}

TEST_CASE("95 % of the intervals hold the true value") {
  int holds = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    const Estimate e =
        evaluate(Lottery{}, Always<0>{}, {.runs = 60, .horizon = 2}, Serial{}, static_cast<std::uint64_t>(trial));
    holds += e.low() < 1.0 && 1.0 < e.high();  // two transitions of a uniform start's mean, 0.5
  }
  const double five_sigma = 5 * std::sqrt(0.95 * 0.05 / trials);
  CHECK(std::abs(holds / static_cast<double>(trials) - 0.95) < five_sigma);
}

TEST_CASE("compared on common random numbers, a small difference stands out from large noise") {
  const DoubleIntegrator problem{.push = 0.2};
  const toy::DoubleIntegratorOptimum optimum(problem, 60);
  const auto timid = [](const Vec<2>& state) { return Vec<1>(-0.9 * state[0] - 1.3 * state[1]); };
  const RolloutOptions options{.runs = 500, .horizon = 60};
  const Estimate difference = compare(problem, optimum, timid, options, Threads{}, 1);
  const Estimate a = evaluate(problem, optimum, options, Serial{}, 1);
  const Estimate b = evaluate(problem, timid, options, Serial{}, 1);
  CHECK(difference.mean == doctest::Approx(a.mean - b.mean));
  CHECK(difference.half_width() < 0.5 * std::hypot(a.half_width(), b.half_width()));
  CHECK(difference.low() > 0);
  CHECK(compare(problem, timid, timid, options, Serial{}, 1).half_width() == 0);
}

TEST_CASE("impossible options are refused by name") {
  const auto with = [](RolloutOptions options) { return evaluate(Staircase{}, Always<0>{}, options, Serial{}, 1); };
  CHECK_THROWS_WITH_AS(with({.runs = 0}), doctest::Contains("runs"), CoreError);
  CHECK_THROWS_WITH_AS(with({.horizon = 0}), doctest::Contains("horizon"), CoreError);
  for (const double discount : {0.0, 1.5, std::nan("")}) {
    CHECK_THROWS_WITH_AS(with({.discount = discount}), doctest::Contains("discount"), CoreError);
  }
}

TEST_CASE("a stop ends the evaluation with an exception instead of a half-counted mean") {
  std::stop_source source;
  source.request_stop();
  CHECK_THROWS_AS(evaluate(Staircase{}, Always<0>{}, {}, Threads(2), 1, source.get_token()), CoreError);
}

}  // namespace
}  // namespace surefoot
