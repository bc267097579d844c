// How the pool of structures grows.
#include "surefoot/diagnose/selection/grow.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a pool grows as long as a further effect makes the best structure better") {
  const TankBench bench({rate_in_tank, drift_in_tank}), nothing({});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  std::vector<std::string> stages;
  search.problem.on_progress = [&](const std::string& stage, double share) {
    stages.push_back(stage);
    CHECK(share >= 0);
    CHECK(share < 1);
  };
  std::vector<Hypothesis> done;
  grow(search, pool, done);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate, sensor_drift");
  CHECK(done.size() > 1);
  CHECK_FALSE(stages.empty());
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(0.01).epsilon(0.1));

  Search idle = nothing.search();
  idle.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  std::vector<EvaluatedHypothesis> clean{nothing.with({})};
  int rounds = 0;
  idle.problem.on_progress = [&](const std::string&, double) { ++rounds; };
  std::vector<Hypothesis> idle_done;
  grow(idle, clean, idle_done);
  CHECK(rounds == 1);
  CHECK(names_in(clean[best_of(clean, nothing.problem.criteria)]).empty());
}

TEST_CASE("where residuals hold structure one step that does not pay is followed by another, but two only if nearer") {
  const auto rounds_with = [](const TankBench& bench) {
    const Search start = bench.search();
    Search search = start;
    int rounds = 0;
    search.problem.on_progress = [&](const std::string&, double) { ++rounds; };
    std::vector<EvaluatedHypothesis> pool{bench.with({})};
    std::vector<Hypothesis> done;
    grow(search, pool, done);
    CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]).empty());
    return rounds;
  };
  TankBench one({rate_in_tank}), two({rate_in_tank, {"sensor_drift", "level_m", {}, {}, {0.3}}});
  for (TankBench* bench : {&one, &two}) {
    bench->problem.criteria.form_cost = 1e4;  // no effect pays
    bench->problem.effort.hopeless = 1e6;
    bench->problem.effort.pairs = bench->problem.effort.combined = 0;  // one effect after the other
  }
  CHECK(rounds_with(one) == 2);
  CHECK(rounds_with(two) == 3);                                    // its second step comes much nearer
  one.problem.effort.hopeless = two.problem.effort.hopeless = 15;  // beyond which is followed only what does so
  CHECK(rounds_with(one) == 2);
  CHECK(rounds_with(two) == 3);
  two.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  CHECK(rounds_with(two) == 1);
}

TEST_CASE("beside effects, one that takes away little of what is far above the noise is the last") {
  const NamedEffect slow{"first_order_lag", "valve", {}, {}, {3.0}};  // no candidate explains it
  TankBench bench({rate_in_tank, slow, {"sensor_bias", "level_m", {}, {}, {0.05}}});
  bench.problem.criteria.form_cost = -20;  // whatever takes anything away pays
  const EvaluatedHypothesis two = bench.with({"constant_rate", "sensor_drift"});
  const auto rounds_beside = [&](double noise) {
    Search search = bench.search();
    search.problem.noise.setConstant(1, noise);
    int rounds = 0;
    search.problem.on_progress = [&](const std::string&, double) { ++rounds; };
    std::vector<EvaluatedHypothesis> pool{two};
    std::vector<Hypothesis> done;
    grow(search, pool, done);
    CHECK(names_in(pool[best_of(pool, search.problem.criteria)]) == "constant_rate, sensor_bias, sensor_drift");
    return rounds;
  };
  const double then = pooled(bench.with({"constant_rate", "sensor_drift", "sensor_bias"}).errors)[0];
  CHECK(rounds_beside(0) == 1);
  CHECK(rounds_beside(then) == 2);
}

TEST_CASE("what stands at a bound is fitted again from inside, unless it would be worse in any case") {
  const TankBench bench({rate_in_tank});
  const Search search = bench.search();
  const EvaluatedHypothesis none = bench.with({});
  const auto at_bound = [&](const char* name) {
    Fit there{bench.start({name}), 0, true};
    const auto variables = variables_of(bench.bound, there.hypothesis, {});
    const auto own = std::find_if(variables.begin(), variables.end(),
                                  [](const Variable& one) { return one.kind == Variable::Kind::effect; });
    there.hypothesis.values[0][0] = own->high;
    return there;
  };
  Fit rate = at_bound("constant_rate");
  EvaluatedHypothesis stuck = evaluate_fit(bench.bound, rate, search.problem, serially());
  stuck.errors = none.errors;  // as near as without it, but for the bound
  REQUIRE(log_odds(stuck, none, search.problem.criteria) < -20);
  EvaluatedHypothesis far = stuck;
  far.errors.mean_squares *= 1e3;
  std::vector<EvaluatedHypothesis> children{stuck, far};
  draw_inside(search, none, children);
  CHECK(children[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.05));
  CHECK(log_odds(children[0], none, search.problem.criteria) > 20);
  CHECK(children[1].hypothesis.values[0][0] == stuck.hypothesis.values[0][0]);
}

TEST_CASE("what was extended before is not extended again") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({"constant_rate"})};
  std::vector<Hypothesis> done{pool.front().hypothesis};
  grow(search, pool, done);
  CHECK(pool.size() == 1);
  done.clear();
  grow(search, pool, done);
  CHECK(pool.size() > 1);
}

TEST_CASE("a search yields to another explanation that does better than its first effects") {
  TankBench bench({rate_in_tank});
  CHECK_FALSE(bench.found().yields);
  bench.problem.rival = 1e9;
  const Selection selection = bench.found();
  CHECK(selection.yields);
  CHECK(selection.chosen.hypothesis.effects.size() <= 1);
}

TEST_CASE("no structure has more effects than are allowed") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.criteria.max_effects = 1;
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  std::vector<Hypothesis> done;
  grow(search, pool, done);
  for (const EvaluatedHypothesis& one : pool) CHECK(one.hypothesis.effects.size() <= 1);
}

TEST_CASE("what comes nearest is extended without what it holds idle as well") {
  const TankBench bench({rate_in_tank});
  const Search search = bench.search();
  std::vector<EvaluatedHypothesis> beam;
  add_with_smaller(search, bench.with({"constant_rate", "sensor_drift"}), beam);
  REQUIRE(beam.size() == 2);
  CHECK(names_in(beam[0]) == "constant_rate, sensor_drift");
  CHECK(names_in(beam[1]) == "constant_rate");
}

TEST_CASE("what does not pay beside the model without effects does not pay") {
  const TankBench sloped({rate_in_tank}), nothing({});
  const std::vector<EvaluatedHypothesis> pool{sloped.with({})}, clean{nothing.with({})};
  CHECK(pays(sloped.search(), sloped.with({"constant_rate"}), pool));
  CHECK_FALSE(pays(sloped.search(), pool[0], pool));
  CHECK_FALSE(pays(nothing.search(), nothing.with({"constant_rate"}), clean));
}

}  // namespace
}  // namespace surefoot::diagnosis
