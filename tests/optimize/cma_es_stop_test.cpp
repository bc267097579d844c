#include "surefoot/optimize/cma_es_stop.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <stop_token>
#include <string_view>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/cma_es_core.hpp"
#include "tests/optimize/test_functions.hpp"

namespace surefoot {
namespace {

using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr CmaEsTolerances all_off{.x = 0, .x_up = infinity, .fun = 0, .condition = infinity, .stagnation = false};

template <class F>
StopReason reason_of(const F& objective, const CmaEsOptions& options, std::stop_token stop = {}) {
  return cma_es(objective, VectorXd::Ones(3), 0.5, options, Serial{}, 1, std::move(stop)).reason;
}

// A state in the middle of nowhere that no criterion complains about.
CmaEsState calm_state() {
  CmaEsState state = cma_es_start(VectorXd::Ones(2), 0.5, 6, 1);
  state.generation = 3;
  return state;
}

TEST_CASE("a value below the target ends the search") {
  CHECK(reason_of(toy::sphere, {.target = 1e-6}) == StopReason::target_reached);
}

TEST_CASE("the budget of evaluations ends the search and is never exceeded") {
  for (const std::uint64_t budget : {7U, 8U, 100U, 1000U}) {
    const auto result =
        cma_es(toy::sphere, VectorXd::Ones(3), 0.5, {.max_evaluations = budget, .tolerances = all_off}, Serial{}, 1);
    CHECK(result.reason == StopReason::max_evaluations);
    CHECK(result.evaluations <= budget);
    CHECK(result.evaluations + 7 > budget);  // a generation is 7
  }
  CHECK_THROWS_WITH_AS(reason_of(toy::sphere, {.max_evaluations = 6}),
                       doctest::Contains("one generation, 7 evaluations"), OptimizeError);
}

TEST_CASE("the time budget ends the search, but not before its first generation") {
  const auto result = cma_es(toy::sphere, VectorXd::Ones(3), 0.5, {.max_seconds = 0}, Serial{}, 1);
  CHECK(result.reason == StopReason::time_budget);
  CHECK(result.evaluations == 7);
  CHECK(result.best.size() == 3);
}

TEST_CASE("a stop request ends the search, between or within generations") {
  std::stop_source stop;
  int generations = 0;
  const auto result = cma_es(toy::sphere, VectorXd::Ones(3), 0.5,
                             {.on_progress =
                                  [&](const CmaEsSearch&) {
                                    if (++generations == 5) stop.request_stop();
                                  }},
                             Serial{}, 1, stop.get_token());
  CHECK(result.reason == StopReason::stop_requested);
  CHECK(result.evaluations == 5 * 7);

  std::stop_source within;
  int calls = 0;
  const auto objective = [&](const VectorXd& x) {
    if (++calls == 3 * 7 + 2) within.request_stop();
    return toy::sphere(x);
  };
  CHECK(cma_es(objective, VectorXd::Ones(3), 0.5, {}, Serial{}, 1, within.get_token()).evaluations == 3 * 7);

  std::stop_source at_once;
  at_once.request_stop();
  CHECK(cma_es(toy::sphere, VectorXd::Ones(3), 0.5, {}, Serial{}, 1, at_once.get_token()).best.size() == 0);
}

TEST_CASE("a narrow distribution is convergence in x") {
  CmaEsTolerances tolerances = all_off;
  tolerances.x = 1e-12;
  CHECK(reason_of(toy::sphere, {.tolerances = tolerances}) == StopReason::tol_x);
}

TEST_CASE("equal values up to a tolerance are convergence in the objective") {
  CmaEsTolerances tolerances = all_off;
  tolerances.fun = 1e-12;
  CHECK(reason_of(toy::sphere, {.tolerances = tolerances}) == StopReason::tol_fun);
}

TEST_CASE("a plateau ends the search") {
  CHECK(reason_of([](const VectorXd&) { return 3.0; }, {}) == StopReason::equal_values);
}

TEST_CASE("values without a trend are stagnation") {
  CHECK(reason_of([](const VectorXd&, Rng& rng) { return rng.normal(); },
                  {.noise = {.common_random_numbers = false}}) == StopReason::stagnation);
}

TEST_CASE("a distribution that grows without end is told") {
  CHECK(reason_of([](const VectorXd& x) { return x.sum(); }, {}) == StopReason::tol_x_up);
}

TEST_CASE("a badly conditioned covariance ends the search") {
  CmaEsTolerances tolerances = all_off;
  tolerances.condition = 1e4;
  CHECK(reason_of(toy::ellipsoid, {.tolerances = tolerances}) == StopReason::condition);
}

TEST_CASE("a covariance that is not positive definite any more ends the search") {
  CmaEsState state = calm_state();
  state.degenerate = true;
  CHECK(converged(state, all_off) == StopReason::condition);
}

TEST_CASE("steps below the precision of a coordinate end the search") {
  CmaEsState state = calm_state();
  state.mean[1] = 1e9;
  CHECK_FALSE(converged(state, all_off));
  state.sigma = 1e-8;  // neighbours of 1e9 are 1.2e-7 apart
  CHECK(converged(state, all_off) == StopReason::no_effect_coordinate);
}

TEST_CASE("steps below the precision along one axis end the search") {
  CmaEsState state = calm_state();
  state.mean.setConstant(1e9);
  state.covariance.setOnes();  // all variance along (1, 1)
  state.factor << 1, 0, 1, 1e-9;
  state.generation = 2;  // looks at the long axis
  CHECK_FALSE(converged(state, all_off));
  state.generation = 3;
  CHECK(converged(state, all_off) == StopReason::no_effect_axis);
}

TEST_CASE("a search of all evaluations that can be counted ends") {
  CmaEsSearch search = cma_es(toy::sphere, VectorXd::Ones(3), 0.5, {.max_evaluations = 100}, Serial{}, 1).search;
  search.evaluations = std::numeric_limits<std::uint64_t>::max() - 2;
  const std::uint64_t before = search.evaluations;
  const auto result = cma_es(toy::sphere, search, {.restarts = Restarts::bipop}, Serial{});
  CHECK(result.reason == StopReason::max_evaluations);
  CHECK(result.search.evaluations == before);
}

TEST_CASE("a state that nothing is wrong with goes on") {
  CHECK_FALSE(converged(calm_state(), {}));
  CHECK_FALSE(converged(cma_es_start(VectorXd::Ones(2), 0.5, 6, 1), {}));
}

TEST_CASE("every reason has a name of its own") {
  std::set<std::string_view> names;
  const int last = static_cast<int>(StopReason::no_effect_coordinate);
  for (int i = 0; i <= last; ++i) names.insert(to_string(static_cast<StopReason>(i)));
  CHECK(static_cast<int>(names.size()) == last + 1);
  CHECK(to_string(StopReason::no_effect_coordinate) == "no effect coordinate");
}

}  // namespace
}  // namespace surefoot
