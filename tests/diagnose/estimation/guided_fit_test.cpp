// Fits under the guidance of the readings, against the valleys of a long horizon.
#include "surefoot/diagnose/estimation/guided_fit.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/rng.hpp"
#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a stiffness so wrong that the swings are out of step is found under guidance") {
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
    const Fit guided = guided_fit(bound, trapped, start, problem, serially());
    CHECK(guided.hypothesis.parameters[0] == doctest::Approx(4).epsilon(1e-3));
    CHECK(guided.hypothesis.parameters[1] == doctest::Approx(0.1).epsilon(1e-2));
  }
}

TEST_CASE("guidance makes no good fit worse, and asks nothing of a model without measured states") {
  BoundSimulator bound = swing();
  Rng rng(3);
  for (double& x : bound.recordings[0].outputs.reshaped()) x += 0.01 * rng.normal();
  FitProblem problem;
  problem.recordings = {0};
  problem.weighting.sigma = Eigen::VectorXd::Ones(1);
  const Fit good = fit(bound, nominal_hypothesis(bound), problem, serially());
  const Fit same = guided_fit(bound, good, nominal_hypothesis(bound), problem, serially());
  CHECK(same.hypothesis.parameters == good.hypothesis.parameters);
  CHECK(same.loss == good.loss);

  Hypothesis far = nominal_hypothesis(bound);
  far.parameters[0] = 12;
  const Fit trapped = fit(bound, far, problem, serially());
  bound.structure.output_of = {-1, -1};
  CHECK(guided_fit(bound, trapped, far, problem, serially()).loss == trapped.loss);
}

}  // namespace
}  // namespace surefoot::diagnosis
