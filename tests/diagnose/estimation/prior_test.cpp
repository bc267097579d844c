// Normal prior of a model's parameters.
#include "surefoot/diagnose/estimation/prior.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("bounds are three standard deviations to either side of the middle, in the coordinates of the search") {
  const BoundSimulator bound = swing();  // stiffness from 0.5 to 50 by its logarithm, rest from -1 to 1
  const Hypothesis nominal = nominal_hypothesis(bound);
  const std::vector<Variable> variables = variables_of(bound, nominal, {0});
  const PriorRows prior = prior_rows(variables, nominal.parameters);
  REQUIRE(prior.mean.size() == 2);
  CHECK(prior.mean[0] == doctest::Approx(std::log(4)));
  CHECK(prior.slope[0] == doctest::Approx(6 / std::log(100)));
  CHECK(prior_rows(variables, {}).mean.size() == 0);
}

TEST_CASE("the rows of the prior stand behind those of the recordings") {
  const BoundSimulator bound = swing();
  const Hypothesis nominal = nominal_hypothesis(bound);
  FitProblem problem = swing_problem();
  const Eigen::Index rows = bound.recordings[0].outputs.size() - 1;  // the first one is where it begins
  const FitFunctions without(bound, nominal, problem, serially());
  CHECK(without.residuals(without.start()).size() == rows);
  problem.prior = nominal.parameters;
  const FitFunctions with(bound, nominal, problem, serially());
  const Eigen::VectorXd z = Vec<2>(std::log(40), 0.0), all = with.residuals(z);
  REQUIRE(all.size() == rows + 2);
  CHECK(all.head(rows) == without.residuals(z));
  CHECK(all[rows] == doctest::Approx(3));  // a tenfold stiffness, of a hundredfold range
  CHECK(all[rows + 1] == 0);
  const Eigen::MatrixXd jacobian = with.jacobian(z, all);
  CHECK(jacobian.topRows(rows) == without.jacobian(z, all.head(rows)));
  CHECK(jacobian(rows, 0) == doctest::Approx(6 / std::log(100)));
  CHECK(jacobian(rows, 1) == 0);
  CHECK(jacobian(rows + 1, 1) == prior_rows(with.variables(), nominal.parameters).slope[1]);
}

TEST_CASE("what recordings do not tell stays where the prior has it, and what they tell is found") {
  BoundSimulator bound = swing();
  bound.recordings[0] = part_of(bound.recordings[0], 0, 3, bound.recordings[0].initial, {});  // too few rows for both
  Hypothesis start = nominal_hypothesis(bound);
  start.parameters[1] = 0.5;
  FitProblem problem = swing_problem();
  problem.weighting.sigma[0] = 0.02;
  const Fit anywhere = fit(bound, start, problem, serially());
  problem.prior = nominal_hypothesis(bound).parameters;
  const Fit near = fit(bound, start, problem, serially());
  CHECK(std::abs(near.hypothesis.parameters[1]) < 0.2);
  CHECK(std::abs(anywhere.hypothesis.parameters[1] - 0.1) > std::abs(near.hypothesis.parameters[1] - 0.1));
  const BoundSimulator whole = swing();
  problem.weighting.sigma[0] = 0.001;
  const Fit told = fit(whole, nominal_hypothesis(whole), problem, serially());
  CHECK(told.hypothesis.parameters[1] == doctest::Approx(0.1).epsilon(1e-3));
}

}  // namespace
}  // namespace surefoot::diagnosis
