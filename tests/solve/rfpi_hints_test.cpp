#include "surefoot/solve/rfpi_hints.hpp"

#include <doctest/doctest.h>

#include "tests/support/double_integrator.hpp"

namespace surefoot {
namespace {

const LearningSigns good{.random_cost = 100,
                         .learnt_cost = 20,
                         .least_reward = -3,
                         .greatest_reward = 0,
                         .ended_share = 0,
                         .mean_length = 100};

TEST_CASE("what goes well gets no hint") { CHECK(hints(good, {.discount = 0.99, .horizon = 100}).empty()); }

TEST_CASE("a discount that hides most of a run is named") {
  const auto found = hints(good, {.discount = 0.9, .horizon = 100});
  REQUIRE(found.size() == 1);
  CHECK(found[0].find("set discount to 0.99") != std::string::npos);
}

TEST_CASE("rewards that are all the same are named") {
  LearningSigns signs = good;
  signs.least_reward = signs.greatest_reward = -1;
  const auto found = hints(signs, {.discount = 0.99, .horizon = 100});
  REQUIRE(found.size() == 1);
  CHECK(found[0].find("same reward, -1") != std::string::npos);
}

TEST_CASE("a policy no better than random actions is named") {
  LearningSigns signs = good;
  signs.learnt_cost = 99;
  const auto found = hints(signs, {.discount = 0.99, .horizon = 100});
  REQUIRE(found.size() == 1);
  CHECK(found[0].find("nothing was learnt yet") != std::string::npos);
}

TEST_CASE("a state box that the policy leaves is named") {
  LearningSigns signs = good;
  signs.outside_share = 0.25;
  const auto found = hints(signs, {.discount = 0.99, .horizon = 100});
  REQUIRE(found.size() == 1);
  CHECK(found[0].find("25 % of the states that the policy leads to are outside state_box()") == 0);
}

TEST_CASE("the share of states outside the box is that of the policy's runs") {
  const toy::DoubleIntegrator problem;  // at rest from within 1 m; the box ends at 1.5 m and 1.5 m/s
  const auto still = [](const Vec<2>&) { return Vec<1>(0); };
  CHECK(detail::learning_signs(problem, still, 30, 1).outside_share == 0);
  const auto away = [](const Vec<2>&) { return Vec<1>(1.5); };  // too fast after ten steps of 0.1 s, or too far before
  const double share = detail::learning_signs(problem, away, 30, 1).outside_share;
  CHECK(share > 0.6);
  CHECK(share < 0.8);
}

TEST_CASE("signs are those of the runs") {
  const toy::DoubleIntegrator problem;
  const auto still = [](const Vec<2>&) { return Vec<1>(0); };
  const LearningSigns signs = detail::learning_signs(problem, still, 30, 1);
  CHECK(signs.mean_length == 30);
  CHECK(signs.ended_share == 0);
  CHECK(signs.least_reward < signs.greatest_reward);
  CHECK(signs.learnt_cost > 0);
}

}  // namespace
}  // namespace surefoot
