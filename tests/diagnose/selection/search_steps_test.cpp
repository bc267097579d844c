// The steps of a search beside the growth of its pool.
#include <doctest/doctest.h>

#include <vector>

#include "surefoot/diagnose/selection/search.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("an effect that only led to the others is taken away again") {
  const TankBench bench({rate_in_tank});
  std::vector<EvaluatedHypothesis> pool{bench.with({"constant_rate", "sensor_drift"}),
                                        bench.with({"constant_rate", "sensor_bias"})};
  take_effects_away(bench.search(), pool);
  CHECK(pool.size() == 4);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
  for (const EvaluatedHypothesis& one : pool) CHECK_FALSE(one.hypothesis.effects.empty());  // none is tried anyway
}

TEST_CASE("an input that was found not to be held is held again where nothing needs that any more") {
  TankBench bench({rate_in_tank});
  bench.problem.fit.integration.inputs = {InputHold::linear};
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"constant_rate"})};
  CHECK(take_back_holds(search, pool));
  CHECK(search.problem.fit.integration.inputs[0] == InputHold::zero_order);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
  CHECK_FALSE(take_back_holds(search, pool));

  bench.read_with_straight_inputs({rate_in_tank});
  Search needed = bench.search();
  std::vector<EvaluatedHypothesis> as_it_is{bench.with({}), bench.with({"constant_rate"})};
  CHECK_FALSE(take_back_holds(needed, as_it_is));
  CHECK(needed.problem.fit.integration.inputs[0] == InputHold::linear);
}

TEST_CASE("what an earlier search found is taken up, with its rivals") {
  const TankBench bench({rate_in_tank});
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  Search search = bench.search();
  CHECK_FALSE(take_up(search, {}, pool));
  CHECK(pool.size() == 1);
  search.problem.structured = [](const Hypothesis& one, const FitProblem&) { return one.effects.empty(); };
  CHECK(take_up(search, {bench.start({"constant_rate"})}, pool));
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
  CHECK(pool.size() > 1);

  Search open = bench.search();
  pool = {bench.with({})};
  CHECK_FALSE(take_up(open, {bench.start({"constant_rate"})}, pool));  // more is missing
}

TEST_CASE("an effect that is not worth its parameters once all has settled is taken away") {
  const TankBench bench({rate_in_tank});
  const Search search = bench.search();
  Selection selection;
  selection.nominal = bench.with({});
  selection.chosen = bench.with({"constant_rate", "sensor_bias"});
  const auto fewer = weigh_effects(search, selection);
  REQUIRE(fewer);
  CHECK(names_in(*fewer) == "constant_rate");

  Selection worth;
  worth.nominal = bench.with({});
  worth.chosen = *fewer;
  CHECK_FALSE(weigh_effects(search, worth));
  CHECK(worth.evidence.size() == 1);
}

}  // namespace
}  // namespace surefoot::diagnosis
