// Fits with a growing horizon, against the valleys of a long one.
#include "surefoot/diagnose/estimation/growing_horizon.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/rng.hpp"
#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a stiffness so wrong that the swings are out of step is found with a growing horizon") {
  const BoundSimulator bound = swing();
  FitProblem problem;
  problem.recordings = {0};
  problem.weighting.sigma = Eigen::VectorXd::Ones(1);
  for (const double stiffness : {1.5, 7.0, 12.0}) {
    CAPTURE(stiffness);
    Hypothesis start = nominal_hypothesis(bound);
    start.parameters[0] = stiffness;
    const Fit trapped = fit(bound, start, problem, serially());
    REQUIRE(std::abs(trapped.hypothesis.parameters[0] - 4) > 0.5);
    const Fit grown = grown_fit(bound, trapped, start, problem, serially());
    CHECK(grown.hypothesis.parameters[0] == doctest::Approx(4).epsilon(1e-3));
    CHECK(grown.hypothesis.parameters[1] == doctest::Approx(0.1).epsilon(1e-2));
  }
}

TEST_CASE("a fit that is no worse stays as it is") {
  BoundSimulator bound = swing();
  Rng rng(3);
  for (double& x : bound.recordings[0].outputs.reshaped()) x += 0.01 * rng.normal();
  FitProblem problem;
  problem.recordings = {0};
  problem.weighting.sigma = Eigen::VectorXd::Ones(1);
  const Fit good = fit(bound, nominal_hypothesis(bound), problem, serially());
  const Fit same = grown_fit(bound, good, nominal_hypothesis(bound), problem, serially());
  CHECK(same.hypothesis.parameters == good.hypothesis.parameters);
  CHECK(same.loss == good.loss);
}

TEST_CASE("beginnings have the wanted share of the rows, and two at least") {
  const BoundSimulator bound = swing();
  const Eigen::Index rows = bound.recordings[0].rows();
  CHECK(beginnings(bound, 0.25).recordings[0].rows() == rows / 4);
  CHECK(beginnings(bound, 1).recordings[0].outputs == bound.recordings[0].outputs);
  CHECK(beginnings(bound, 0).recordings[0].rows() == 2);
  CHECK(beginnings(bound, 0.25).recordings[0].initial == bound.recordings[0].initial);
}

}  // namespace
}  // namespace surefoot::diagnosis
