#include "surefoot/core/problem.hpp"

#include <doctest/doctest.h>

#include "tests/support/cart_pole.hpp"
#include "tests/support/double_integrator.hpp"
#include "tests/support/grid_policy.hpp"
#include "tests/support/pendulum.hpp"
#include "tests/support/problem_conformance.hpp"

namespace surefoot {
namespace {

using toy::CartPole;
using toy::DoubleIntegrator;
using toy::Pendulum;

TEST_CASE_TEMPLATE("the toy problems are fit for use", P, DoubleIntegrator, Pendulum, CartPole) {
  toy::check_problem(P{});
}

TEST_CASE("features are the problem's own, else the state itself") {
  CHECK(feature_dim<Pendulum>() == 3);
  CHECK(features(Pendulum{}, Vec<2>(0, 2)) == Vec<3>(1, 0, 2));
  CHECK(feature_dim<DoubleIntegrator>() == 2);
  CHECK(features(DoubleIntegrator{}, Vec<2>(0, 2)) == Vec<2>(0, 2));
}

TEST_CASE("states without names of their own are numbered") {
  CHECK(state_names(Pendulum{}) == std::vector<std::string>{"state 0", "state 1"});
}

TEST_CASE("the double integrator's optimum costs what the Riccati equation says, with and without noise") {
  for (const double push : {0.0, 0.05}) {
    const DoubleIntegrator problem{.push = push};
    const toy::DoubleIntegratorOptimum optimum(problem, 100);
    const Estimate value = evaluate(problem, optimum, {.runs = 4000, .horizon = 100}, Threads{}, 1);
    CAPTURE(push);
    CHECK(std::abs(value.mean - optimum.expected_return()) < 5 * value.standard_error);
  }
}

TEST_CASE("the double integrator's optimum is exact for a single start, and better than its neighbours") {
  const DoubleIntegrator problem;
  const toy::DoubleIntegratorOptimum optimum(problem, 100);
  const Vec<2> start(0.8, -0.3);
  const double best = run_return(problem, optimum, start, 100, 1.0, Rng(1));
  CHECK(best == doctest::Approx(optimum.expected_return(start)));
  for (const double factor : {0.9, 1.1}) {
    auto other = [&, policy = optimum](const Vec<2>& state) mutable { return Vec<1>(factor * policy(state)); };
    double sum = 0;
    Vec<2> state = start;
    Rng rng(1);
    for (int t = 0; t < 100; ++t) {
      const auto step = problem.step(state, other(state), rng);
      sum += step.reward;
      state = step.next;
    }
    CHECK(sum < best);
  }
}

TEST_CASE("dynamic programming on a grid comes within a tenth of the double integrator's optimum") {
  const DoubleIntegrator problem;
  const toy::GridPolicy grid(problem, 41, 21, 60);
  const toy::DoubleIntegratorOptimum optimum(problem, 60);
  const RolloutOptions options{.runs = 100, .horizon = 60};
  const double cost = -evaluate(problem, grid, options, Threads{}, 1).mean;
  const double best = -evaluate(problem, optimum, options, Threads{}, 1).mean;
  CHECK(cost >= best);
  CHECK(cost < 1.1 * best);
}

TEST_CASE("the pendulum is swung up by dynamic programming for less than the published costs, and not by itself") {
  const Pendulum problem;
  const toy::GridPolicy grid(problem, 51, 5, Pendulum::horizon);
  const RolloutOptions options{.runs = 300, .horizon = Pendulum::horizon};
  CHECK(evaluate(problem, grid, options, Threads{}, 1).high() > -151.9);
  const auto limp = [](const Vec<2>&) { return Vec<1>(0.0); };
  CHECK(evaluate(problem, limp, options, Threads{}, 1).mean < -1000);
}

TEST_CASE("the cart-pole's pole falls by itself, and never under linear feedback") {
  const CartPole problem;
  const RolloutOptions options{.runs = 100, .horizon = CartPole::horizon};
  const Estimate balanced = evaluate(problem, toy::CartPoleBalancer{}, options, Threads{}, 1);
  CHECK(balanced.mean == CartPole::horizon);
  CHECK(balanced.standard_error == 0);
  const auto still = [](const Vec<4>&) { return Vec<1>(0.0); };
  CHECK(evaluate(problem, still, options, Threads{}, 1).mean < 200);
}

}  // namespace
}  // namespace surefoot
