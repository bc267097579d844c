// What a hypothesis leaves against what noise does, and against a rival explanation.
#include "surefoot/diagnose/selection/explains.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a hypothesis explains the recordings if it leaves no more than noise, or nothing that noise does not") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  const EvaluatedHypothesis one = bench.with({"constant_rate"});
  CHECK(leaves_structure(search, one));  // as a problem that does not say otherwise
  CHECK_FALSE(explains(search, one));
  search.problem.noise = pooled(one.errors);
  CHECK(explains(search, one));
  search.problem.noise *= 0.5;
  CHECK_FALSE(explains(search, one));
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  CHECK_FALSE(leaves_structure(search, one));
  CHECK(explains(search, one));
}

TEST_CASE("the loss at the noise is in proportion to what is left, and as it is where the noise is not known") {
  const TankBench bench({rate_in_tank});
  SearchProblem problem = bench.problem;
  const EvaluatedHypothesis none = bench.with({});
  CHECK(loss_at_noise(none, problem) == none.loss);
  problem.noise = 0.1 * pooled(none.errors);
  CHECK(loss_at_noise(none, problem) ==
        doctest::Approx(0.1 * (1 + problem.criteria.tolerated_form) * none.loss).epsilon(1e-9));
  problem.noise = 2 * pooled(none.errors);  // it leaves less already
  CHECK(loss_at_noise(none, problem) == none.loss);
}

TEST_CASE("a pool yields to another explanation that does better against the model without effects") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  const std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"constant_rate"})};
  CHECK_FALSE(yields(search, pool));  // there is none
  const double odds = log_odds(pool[1], pool[0], search.problem.criteria);
  search.problem.rival = odds - 1;
  CHECK_FALSE(yields(search, pool));
  search.problem.rival = odds + 1;
  CHECK(yields(search, pool));
  CHECK_FALSE(yields(search, {pool[1]}));  // without it they cannot be compared
}

}  // namespace
}  // namespace surefoot::diagnosis
