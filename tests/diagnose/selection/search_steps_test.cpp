// The steps of a search: how the pool of structures grows.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "surefoot/diagnose/selection/search.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the pool keeps the better of two forms of a structure") {
  const TankBench bench({});
  EvaluatedHypothesis good = bench.with({"constant_rate"}), bad = good;
  bad.errors.mean_squares *= 9;
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  CHECK(keep_best_form(pool, bad, criteria));
  CHECK(keep_best_form(pool, good, criteria));
  CHECK_FALSE(keep_best_form(pool, bad, criteria));
  CHECK_FALSE(keep_best_form(pool, good, criteria));
  REQUIRE(pool.size() == 2);
  CHECK(pool[1].errors.rms() == good.errors.rms());
}

TEST_CASE("a form with fewer parameters that leaves no more is kept, whatever the odds") {
  const TankBench bench({});
  EvaluatedHypothesis plain = bench.with({"constant_rate"}), vague = plain;
  Effect longer = *vague.hypothesis.effects[0].effect;
  longer.parameters.push_back(longer.parameters[0]);
  vague.hypothesis.effects[0].effect = std::make_shared<const Effect>(longer);
  vague.hypothesis.values[0] = Eigen::VectorXd::Ones(2);
  vague.log_prior += 100;
  REQUIRE(vague.parameter_count() > plain.parameter_count());
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{plain};
  CHECK_FALSE(keep_best_form(pool, vague, criteria));
  pool = {vague};
  CHECK(keep_best_form(pool, plain, criteria));
  vague.errors.mean_squares *= 0.9;  // it leaves less: the odds decide
  CHECK(keep_best_form(pool, vague, criteria));
}

TEST_CASE("weights follow what the best structure leaves, but no further than errors of the integration") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.screened = {0, 1};
  const EvaluatedHypothesis none = bench.with({}), best = bench.with({"constant_rate"});
  reweight(search, none);
  const double before = search.problem.fit.weighting.sigma[0];
  CHECK(before == doctest::Approx(none.errors.rms() * search.problem.scale.sigma[0]).epsilon(0.1));
  reweight(search, best);
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(0.01).epsilon(0.1));
  CHECK(search.problem.screened.size() == 2);
  CHECK(search.problem.fit.weighting.scale.size() == 6);
  search.problem.criteria.least_error = 10;
  reweight(search, best);
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(10 * search.problem.scale.sigma[0]));
}

TEST_CASE("what effects explain is integrated more finely, never more coarsely") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  const EvaluatedHypothesis best = bench.with({"constant_rate"});
  Integration& now = search.problem.fit.integration;
  now = {.order = 2, .step = 0.07};  // rows are 0.05 s long, and the coarsest steps one and a half of them
  search.problem.fit.weighting.sigma[0] = 1;
  CHECK_FALSE(refine_integration(search, best));
  search.problem.fit.weighting.sigma[0] = 1e-6;
  CHECK(refine_integration(search, best));
  CHECK((now.order == 4 || now.step < 0.07));
  const Integration fine = now;
  search.problem.fit.weighting.sigma[0] = 1;
  CHECK_FALSE(refine_integration(search, best));
  CHECK(now.order == fine.order);
  CHECK(now.step == fine.step);
}

TEST_CASE("the search begins a second time from the nominal parameters, with their weights, and keeps its own") {
  TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.fit.weighting.sigma[0] = 0.001;
  const auto children = extended_from(search, bench.problem.nominal, nullptr);
  REQUIRE_FALSE(children.empty());
  const EvaluatedHypothesis& best = children[best_of(children, bench.problem.criteria)];
  CHECK(names_in(best) == "constant_rate");
  CHECK(best.loss < 1);  // in units of what the nominal parameters leave
  CHECK(search.problem.fit.weighting.sigma[0] == 0.001);
  search.problem.stopped = [] { return true; };
  CHECK(extended_from(search, bench.problem.nominal, nullptr).empty());
}

TEST_CASE("from the parameters of two effects that stand in for one, that one is found") {
  const TankBench bench({rate_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  const Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift", "sensor_bias"})};
  REQUIRE(search.effects(pool[best_of(pool, criteria)]) == 2);
  begin_anew(search, pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate");

  std::vector<EvaluatedHypothesis> single{bench.with({}), bench.with({"sensor_drift"})};
  begin_anew(search, single);
  CHECK(single.size() == 2);  // the search began with single effects
}

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

TEST_CASE("a first effect whose fit ended in a valley is tried from places around before others mend it") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.structured = [](const Hypothesis& one, const FitProblem&) {
    return one.effects.size() != 1 || std::abs(one.values[0][0] - 0.2) > 0.02;
  };
  const Fit unfinished{bench.start({"constant_rate"}), 0, true};
  std::vector<EvaluatedHypothesis> children{evaluate_fit(bench.bound, unfinished, bench.problem, bench.parallel)};
  begin_elsewhere(search, children);
  REQUIRE(children.size() == 1);
  CHECK(children[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
}

TEST_CASE("where residuals hold structure one step that does not pay is followed by another, but not two") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.criteria.form_cost = 1e4;  // no effect pays
  bench.problem.effort.hopeless = 1e6;
  const auto rounds_with = [&bench](const Search& start) {
    Search search = start;
    int rounds = 0;
    search.problem.on_progress = [&](const std::string&, double) { ++rounds; };
    std::vector<EvaluatedHypothesis> pool{bench.with({})};
    std::vector<Hypothesis> done;
    grow(search, pool, done);
    CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]).empty());
    return rounds;
  };
  CHECK(rounds_with(bench.search()) == 2);
  bench.problem.effort.hopeless = 15;  // behind the best one, beyond which nothing is followed
  CHECK(rounds_with(bench.search()) == 1);
  bench.problem.effort.hopeless = 1e6;
  bench.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  CHECK(rounds_with(bench.search()) == 1);
}

TEST_CASE("an effect that only led to the others is taken away again") {
  const TankBench bench({rate_in_tank});
  std::vector<EvaluatedHypothesis> pool{bench.with({"constant_rate", "sensor_drift"}),
                                        bench.with({"constant_rate", "sensor_bias"})};
  take_effects_away(bench.search(), pool);
  CHECK(pool.size() == 4);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
  for (const EvaluatedHypothesis& one : pool) CHECK_FALSE(one.hypothesis.effects.empty());  // none is tried anyway
}

TEST_CASE("a first effect that leaves only noise needs no other start") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> children{bench.with({"constant_rate"})};
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  begin_elsewhere(search, children);
  CHECK(children.size() == 1);
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return true; };
  begin_elsewhere(search, children);
  CHECK(children.size() > 1);
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

TEST_CASE("an input that was found not to be held is held again where nothing needs that any more") {
  TankBench bench({rate_in_tank});
  bench.problem.fit.integration.inputs = {InputHold::linear};
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"constant_rate"})};
  CHECK(take_back_holds(search, pool));
  CHECK(search.problem.fit.integration.inputs[0] == InputHold::zero_order);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
  CHECK_FALSE(take_back_holds(search, pool));

  Rng rng(2);
  Integration straight;
  straight.inputs = {InputHold::linear};
  for (Recording& recording : bench.bound.recordings) {
    recording.outputs =
        simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, {rate_in_tank}, straight), recording).outputs;
    for (double& level : recording.outputs.reshaped()) level += 0.01 * rng.normal();
  }
  Search needed = bench.search();
  std::vector<EvaluatedHypothesis> as_it_is{bench.with({}), bench.with({"constant_rate"})};
  CHECK_FALSE(take_back_holds(needed, as_it_is));
  CHECK(needed.problem.fit.integration.inputs[0] == InputHold::linear);
}

TEST_CASE("what an earlier search found is taken up, with its rivals") {
  const TankBench bench({rate_in_tank});
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  take_up(bench.search(), {}, pool);
  CHECK(pool.size() == 1);
  take_up(bench.search(), {bench.start({"constant_rate"})}, pool);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
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

TEST_CASE("the best structures are fitted again, always with the model without effects, and none gets worse") {
  const TankBench bench({rate_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  Hypothesis far = bench.start({"constant_rate"});
  far.values[0][0] = 0.19;
  const Fit unfinished{far, 0, true};
  std::vector<EvaluatedHypothesis> pool{bench.with({}),
                                        evaluate_fit(bench.bound, unfinished, bench.problem, bench.parallel)};
  const auto again = fitted_again(bench.search(), pool);
  REQUIRE(again.size() == 2);
  CHECK(again[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
  CHECK(names_in(again[1]).empty());
  refit_best(bench.search(), pool);
  REQUIRE(pool.size() == 2);
  CHECK(pool[1].errors.rms() == again[0].errors.rms());
  CHECK(log_odds(pool[1], pool[0], criteria) > 0);
  Search stopped = bench.search();
  stopped.problem.stopped = [] { return true; };
  std::vector<EvaluatedHypothesis> same{bench.with({})};
  same[0].loss = 7;
  refit_best(stopped, same);
  CHECK(same[0].loss == 7);
}

TEST_CASE("effects of the best structure are taken away and replaced in turn") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift", "sensor_bias"})};
  swap_effects(bench.search(), pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate, sensor_drift");
  const auto has = [&](const std::string& names) {
    return std::ranges::any_of(pool, [&](const EvaluatedHypothesis& one) { return names_in(one) == names; });
  };
  CHECK(has("sensor_drift"));
  CHECK(has("sensor_bias"));
}

TEST_CASE("what an effect may be confused with is tried in its place, beside the parameters found with it") {
  const TankBench bench({rate_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({"sensor_drift"})};
  REQUIRE(names_in(pool[best_of(pool, criteria)]) == "sensor_drift");
  try_confusable(bench.search(), pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate");
  for (const EvaluatedHypothesis& one : pool) CHECK(one.hypothesis.effects.size() <= 1);  // in its place, not beside it

  Search stopped = bench.search();
  stopped.problem.stopped = [] { return true; };
  std::vector<EvaluatedHypothesis> same{bench.with({"sensor_drift"})};
  try_confusable(stopped, same);
  CHECK(same.size() == 1);
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
