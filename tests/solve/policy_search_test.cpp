#include "surefoot/solve/policy_search.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <stop_token>

#include "tests/support/double_integrator.hpp"

namespace surefoot {
namespace {

using toy::DoubleIntegrator;
using toy::DoubleIntegratorOptimum;

// Pulls back to the origin by position and speed.
struct Feedback {
  Vec<2> gains;
  Vec<1> operator()(const Vec<2>& state) const { return Vec<1>(-gains.dot(state)); }
};
constexpr auto make_feedback = [](const Vec<2>& gains) { return Feedback{gains}; };

const DoubleIntegrator problem{.push = 0.02};
const Box<2> gain_box{Vec<2>(0, 0), Vec<2>(5, 5)};
constexpr int horizon = 60;
const PolicySearchOptions small{
    .horizon = horizon, .min_runs = 4, .max_runs = 16, .total_runs = 10'000, .final_runs = 1000};

TEST_CASE("linear gains come within 3 % of the optimum of a linear-quadratic problem") {
  const double optimum = DoubleIntegratorOptimum(problem, horizon).expected_return();
  const auto result = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Serial{}, 1);
  CHECK(result.value.high() > 1.03 * optimum);  // returns are negative
  CHECK(result.value.low() < optimum);
  CHECK(result.finalists.front().parameters == Vec<2>(4, 1));
  CHECK(result.finalists.front().value.mean < 1.2 * optimum);
  CHECK(result.reason == StopReason::max_evaluations);
  CHECK(result.runs <= small.total_runs);
  CHECK(result.runs > 9000);
}

TEST_CASE("the winner has the best mean of the finals, and its value comes from other runs") {
  const auto result = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Serial{}, 2);
  const auto best = std::ranges::max_element(result.finalists, {}, [](const auto& f) { return f.value.mean; });
  CHECK(result.parameters == best->parameters);
  CHECK(result.value.runs == 1000);
  CHECK(result.value.mean != best->value.mean);
  CHECK(gain_box.contains(result.parameters));
}

TEST_CASE("the result has the same bits on any number of threads") {
  const auto serial = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Serial{}, 3);
  const auto threads = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Threads(3), 3);
  CHECK(serial.parameters == threads.parameters);
  CHECK(serial.value.mean == threads.value.mean);
  CHECK(serial.runs == threads.runs);
  const auto other = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Serial{}, 4);
  CHECK(serial.parameters != other.parameters);
}

TEST_CASE("the scale of a parameter does not matter") {
  const auto make_scaled = [](const Vec<2>& p) { return Feedback{Vec<2>(p[0] * 1024, p[1] / 1024)}; };
  const Box<2> box{Vec<2>(0, 0), Vec<2>(5.0 / 1024, 5.0 * 1024)};
  const auto plain = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Serial{}, 5);
  const auto scaled = policy_search(problem, make_scaled, Vec<2>(4.0 / 1024, 1024), box, small, Serial{}, 5);
  CHECK(scaled.value.mean == plain.value.mean);
}

TEST_CASE("a start that the search cannot beat is kept") {
  // Everything but the start fails.
  const Vec<2> start(1, 1.5);
  const auto make_policy = [&](const Vec<2>& p) { return Feedback{p == start ? p : Vec<2>(-5, -5)}; };
  PolicySearchOptions brief = small;
  brief.total_runs = 200;
  CHECK(policy_search(problem, make_policy, start, gain_box, brief, Serial{}, 6).parameters == start);
}

// The gain grows with the time of the run: only right if every run starts with a reset.
struct Aging {
  Vec<2> gains;
  int age = 0;
  void reset() { age = 0; }
  Vec<1> operator()(const Vec<2>& state) { return Vec<1>(-gains.dot(state) * (age++ < horizon ? 1.0 : -100.0)); }
};

TEST_CASE("policies with memory are reset for every run") {
  const auto make_aging = [](const Vec<2>& gains) { return Aging{gains}; };
  const auto plain = policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, small, Serial{}, 7);
  const auto aging = policy_search(problem, make_aging, Vec<2>(4, 1), gain_box, small, Serial{}, 7);
  CHECK(aging.value.mean == plain.value.mean);
}

TEST_CASE("a stop request ends the search and the best so far is returned") {
  std::stop_source stop;
  PolicySearchOptions options = small;
  int generations = 0;
  options.on_progress = [&](const CmaEsSearch&) {
    if (++generations == 20) stop.request_stop();
  };
  const auto result =
      policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, options, Serial{}, 8, stop.get_token());
  CHECK(result.reason == StopReason::stop_requested);
  CHECK(generations == 20);
  CHECK(result.value.mean > result.finalists.front().value.mean);
}

TEST_CASE("a budget of time ends the search") {
  PolicySearchOptions options = small;
  options.max_seconds = 0;
  CHECK(policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, options, Serial{}, 9).reason ==
        StopReason::time_budget);
}

TEST_CASE("options that make no sense are refused by name") {
  const auto run = [](auto change) {
    PolicySearchOptions options = small;
    change(options);
    policy_search(problem, make_feedback, Vec<2>(4, 1), gain_box, options, Serial{}, 1);
  };
  CHECK_THROWS_WITH_AS(run([](auto& o) { o.min_runs = 1; }), doctest::Contains("min_runs"), SolveError);
  CHECK_THROWS_WITH_AS(run([](auto& o) { o.max_runs = 3; }), doctest::Contains("max_runs"), SolveError);
  CHECK_THROWS_WITH_AS(run([](auto& o) { o.total_runs = 10; }), doctest::Contains("total_runs"), SolveError);
  CHECK_THROWS_WITH_AS(run([](auto& o) { o.final_runs = 0; }), doctest::Contains("final_runs"), SolveError);
  CHECK_THROWS_AS(run([](auto& o) { o.horizon = 0; }), Error);
  CHECK_THROWS_AS(policy_search(problem, make_feedback, Vec<2>(9, 1), gain_box, small, Serial{}, 1), Error);
}

}  // namespace
}  // namespace surefoot
