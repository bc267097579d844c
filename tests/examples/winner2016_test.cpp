#include "examples/sigmaban/approach/winner2016.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"

using sigmaban::Approach;
using sigmaban::Winner2016;
using sigmaban::Winner2016Parameters;
using Mode = sigmaban::Winner2016::Mode;

namespace {

/// Ball at distance d [m] in direction b [rad], target in direction k [rad], with these speeds.
Approach::State state(double d, double b, double k, const surefoot::Vec<3>& speed = {0, 0, 0}) {
  Approach::State s;
  s << d, b, k, speed;
  return s;
}

}  // namespace

TEST_CASE("the policy costs what was published") {
  const surefoot::RolloutOptions options{.runs = 10'000, .horizon = Approach::horizon};
  const auto cost = [&](const Approach& problem, const Winner2016Parameters& parameters) {
    const auto value = surefoot::evaluate(problem, Winner2016(parameters), options, surefoot::Threads{}, 1);
    MESSAGE(-value.mean << " +- " << value.half_width());
    return -value.mean;
  };
  CHECK(std::abs(cost(Approach::ha(), Winner2016Parameters::winner2016()) - 31.82) <= 0.3);
  CHECK(std::abs(cost(Approach::anha(), Winner2016Parameters::winner2016()) - 43.83) <= 0.3);
  CHECK(std::abs(cost(Approach::ha(), Winner2016Parameters::tuned()) - 15.36) <= 0.3);
  CHECK(std::abs(cost(Approach::anha(), Winner2016Parameters::tuned()) - 35.93) <= 0.3);
}

TEST_CASE("the modes follow each other: far, rotate, near, and back") {
  Winner2016 policy;
  policy.reset();
  policy(state(0.9, 0, 0));
  CHECK(policy.mode() == Mode::Far);  // aligned, but far away
  policy(state(0.7, 1, 1));
  CHECK(policy.mode() == Mode::Rotate);
  policy(state(0.9, 1, 1));
  CHECK(policy.mode() == Mode::Rotate);  // only max_rotate_radius brings it back
  policy(state(0.5, 0.1, 0.3));
  CHECK(policy.mode() == Mode::Rotate);  // the target is off
  policy(state(0.5, 0.3, 0.1));
  CHECK(policy.mode() == Mode::Rotate);  // the ball is off
  policy(state(0.5, 0.1, 0.1));
  CHECK(policy.mode() == Mode::Near);
  policy(state(0.5, -1.2, 1));
  CHECK(policy.mode() == Mode::Near);  // a ball to the right does not bring it back
  policy(state(0.5, 1.2, 1));
  CHECK(policy.mode() == Mode::Rotate);
  policy(state(1.01, 0, 1));
  CHECK(policy.mode() == Mode::Far);
}

TEST_CASE("one call passes through as many modes as apply") {
  Winner2016 policy;
  policy.reset();
  policy(state(0.5, 0.1, 0.1));
  CHECK(policy.mode() == Mode::Near);
}

TEST_CASE("far away it walks at the ball, never backwards") {
  Winner2016 policy;
  CHECK(policy(state(0.9, 0.5, 1)).isApprox(surefoot::Vec<3>{0.04 * std::cos(0.5), 0, 0.1}));
  CHECK(policy(state(0.9, 2.0, 1)).isApprox(surefoot::Vec<3>{0, 0, 0.4}));
}

TEST_CASE("rotating it keeps its distance and faces the ball") {
  Winner2016 policy;
  CHECK(policy(state(0.7, 0.5, 1)).isApprox(surefoot::Vec<3>{0.02, -0.2, 0.15}));
}

TEST_CASE("near the ball it walks forward only with the ball ahead and turns only outside the tolerance") {
  Winner2016 policy;
  policy(state(0.4, 0, 0));
  REQUIRE(policy.mode() == Mode::Near);
  const double x = 0.4 * std::cos(0.1), y = 0.4 * std::sin(0.1);
  CHECK(policy(state(0.4, 0.1, 0.1)).isApprox(surefoot::Vec<3>{0.1 * (x - 0.22), 0.06 * y, 0}));
  const double left = 0.4 * std::sin(0.5);
  CHECK(policy(state(0.4, 0.5, 0.2)).isApprox(surefoot::Vec<3>{0, 0.06 * left, 0.02}));
}

TEST_CASE("an action is the wished speed less the current one") {
  const surefoot::Vec<3> speed{0.01, -0.01, 0.1};
  const surefoot::Vec<3> from_rest = Winner2016()(state(0.9, 0.5, 1));
  CHECK(Winner2016()(state(0.9, 0.5, 1, speed)).isApprox(from_rest - speed));
}

TEST_CASE("parameters survive the way to a vector and back, and both published sets lie in the tuning box") {
  for (const auto& parameters : {Winner2016Parameters::winner2016(), Winner2016Parameters::tuned()}) {
    CHECK(Winner2016Parameters::from_vec(parameters.vec()).vec() == parameters.vec());
    CHECK(sigmaban::winner2016_box().contains(parameters.vec()));
  }
  const auto tuned = Winner2016Parameters::tuned().vec();
  for (int i = 0; i < Winner2016Parameters::count; ++i) {
    surefoot::Vec<15> changed = tuned;
    changed[i] += 0.25;
    CHECK(Winner2016Parameters::from_vec(changed).vec() == changed);
  }
}
