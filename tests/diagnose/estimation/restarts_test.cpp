// Restarts against local minima near where a fit ended.
#include "surefoot/diagnose/estimation/restarts.hpp"

#include <doctest/doctest.h>

#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a fit that ended in a local minimum gets out of it") {
  const BoundSimulator bound = swing();
  FitProblem problem;
  problem.recordings = {0};
  problem.weighting.sigma = Eigen::VectorXd::Ones(1);
  Hypothesis start = nominal_hypothesis(bound);
  start.parameters[0] = 7;
  const Fit trapped = fit(bound, start, problem, serially());
  REQUIRE(trapped.hypothesis.parameters[0] > 5);
  FitProblem quick = problem;
  quick.max_iterations = 4;
  const Fit free = restarted_fit(bound, trapped, problem, quick, 8, 1, serially());
  CHECK(free.hypothesis.parameters[0] == doctest::Approx(4).epsilon(1e-4));
  CHECK(free.loss < 1e-6 * trapped.loss);
  const Fit same = restarted_fit(bound, free, problem, quick, 8, 1, serially());
  CHECK(same.hypothesis.parameters == free.hypothesis.parameters);
}

TEST_CASE("places around a fit are within a factor of two, and the same for the same seed") {
  const BoundSimulator bound = swing();
  Hypothesis fitted = nominal_hypothesis(bound);
  fitted.parameters = Eigen::Vector2d(40, -0.4);
  const auto places = moved_around(bound, fitted, 20, 3);
  REQUIRE(places.size() == 20);
  for (const Hypothesis& one : places) {
    CHECK(one.parameters[0] >= 20);
    CHECK(one.parameters[0] <= 50);  // the bound
    CHECK(one.parameters[1] >= -0.6);
    CHECK(one.parameters[1] <= -0.2);
  }
  CHECK(places[0].parameters != places[1].parameters);
  CHECK(moved_around(bound, fitted, 20, 3)[7].parameters == places[7].parameters);
}

}  // namespace
}  // namespace surefoot::diagnosis
