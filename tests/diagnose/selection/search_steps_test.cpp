// The steps of a search: fits of what is proposed, and how the pool of structures grows.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "surefoot/diagnose/selection/search.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

std::vector<Proposal> proposals_without_effects(const TankBench& bench) {
  return proposals_for(bench.search(), bench.with({}));
}

// An effect in the tank with which nothing can be simulated.
Proposal explosion() {
  Effect effect;
  effect.name = "explosion";
  effect.place = Place::state;
  effect.force = [](const EffectContext&, Values, Values) { return std::numeric_limits<double>::infinity(); };
  Proposal one;
  one.effect = {std::make_shared<const Effect>(effect), 0, -1, "level", 0};
  return one;
}

TEST_CASE("effects are proposed that a parent has not yet, the most promising first") {
  const TankBench bench({rate_in_tank});
  const auto first = proposals_without_effects(bench);
  REQUIRE(first.size() == 3);
  CHECK(first[0].effect.effect->name == "constant_rate");
  for (std::size_t i = 1; i < first.size(); ++i) CHECK(first[i].gain <= first[i - 1].gain);
  for (const Proposal& one : proposals_for(bench.search(), bench.with({"constant_rate"}))) {
    CHECK(one.effect.effect->name != "constant_rate");
  }
}

TEST_CASE("signatures that the parameters of the model can make as well are not proposed") {
  TankBench bench({rate_in_tank});
  bench.problem.criteria.least_distinct = 2;  // more than all of it
  CHECK(proposals_without_effects(bench).empty());
}

TEST_CASE("a proposal is fitted from where it starts; what cannot be simulated has no fit") {
  const TankBench bench({rate_in_tank});
  const auto proposals = proposals_without_effects(bench);
  const Hypothesis parent = bench.with({}).hypothesis;
  const Fit fitted = fit_child(bench.bound, parent, {proposals.at(0)}, bench.problem);
  REQUIRE(fitted.ok);
  CHECK(names_in(fitted.hypothesis) == "constant_rate");
  CHECK(fitted.hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
  CHECK_FALSE(fit_child(bench.bound, parent, {explosion()}, bench.problem).ok);
  CHECK(names_in(fit_child(bench.bound, parent, {proposals.at(1), proposals.at(0)}, bench.problem).hypothesis)
            .find("constant_rate, ") == 0);
}

TEST_CASE("a start that is too bold to be simulated is followed by a weak one") {
  const TankBench bench({rate_in_tank});
  Effect brittle = effects::constant_rate();
  brittle.force = [](const EffectContext&, Values p, Values) {
    return p[0] < 0.5 ? p[0] : std::numeric_limits<double>::infinity();
  };
  Proposal bold = proposals_without_effects(bench).at(0);
  bold.effect.effect = std::make_shared<const Effect>(brittle);
  bold.start[0] = 1;
  const Fit fitted = fit_child(bench.bound, bench.with({}).hypothesis, {bold}, bench.problem);
  REQUIRE(fitted.ok);
  CHECK(fitted.hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
}

TEST_CASE("of all children the best are kept, and what cannot be simulated is given up") {
  const TankBench bench({rate_in_tank});
  std::vector<std::vector<Proposal>> additions{{explosion()}};
  for (const Proposal& one : proposals_without_effects(bench)) additions.insert(additions.begin(), {one});
  REQUIRE(additions.size() == 4);
  const Hypothesis parent = bench.with({}).hypothesis;
  const auto all = fit_children(bench.bound, parent, additions, bench.problem, 10, bench.parallel);
  REQUIRE(all.size() == 3);
  CHECK(names_in(all[0].hypothesis) == "constant_rate");
  for (std::size_t i = 1; i < all.size(); ++i) CHECK(all[i].loss >= all[i - 1].loss);
  const auto one = fit_children(bench.bound, parent, additions, bench.problem, 1, bench.parallel);
  REQUIRE(one.size() == 1);
  CHECK(one[0].loss == all[0].loss);
}

TEST_CASE("an effect is taken away with its parameters") {
  const TankBench bench({});
  Hypothesis whole = bench.start({"sensor_drift", "constant_rate", "sensor_bias"});
  whole.values[2][0] = 0.3;
  const Hypothesis rest = without_effect(whole, 1);
  REQUIRE(rest.effects.size() == 2);
  CHECK(rest.effects[1].effect->name == "sensor_bias");
  CHECK(rest.values.at(1)[0] == 0.3);
}

TEST_CASE("without one of its effects a structure is fitted again: the other one does what it can") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const EvaluatedHypothesis both = bench.with({"constant_rate", "sensor_drift"});
  const EvaluatedHypothesis rest = bench.search().without(both, 0);
  CHECK(names_in(rest) == "sensor_drift");
  CHECK(rest.errors.rms() > 2 * both.errors.rms());
  CHECK(rest.loss <= 1.001 * bench.with({"sensor_drift"}).loss);
}

TEST_CASE("further effects are evaluated one by one or in pairs, as many as are finished") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const Search search = bench.search();
  const EvaluatedHypothesis none = bench.with({});
  const auto proposals = proposals_for(search, none);
  const auto singles = next_effects(search, none, proposals, 3, 2);
  REQUIRE(singles.size() == 2);
  for (const EvaluatedHypothesis& one : singles) {
    CHECK(one.hypothesis.effects.size() == 1);
    CHECK(log_odds(one, none, bench.problem.criteria) > 0);
  }
  CHECK(next_effects(search, none, proposals, 1, 2).size() == 1);
  const auto pairs = next_pairs(search, none, proposals);
  REQUIRE_FALSE(pairs.empty());
  CHECK(pairs.size() <= bench.problem.effort.pair_finalists);
  CHECK(names_in(pairs[best_of(pairs, bench.problem.criteria)]) == "constant_rate, sensor_drift");
}

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

TEST_CASE("the best structures come in their order, and hopeless ones are left out") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"constant_rate", "sensor_drift"}),
                                              bench.with({"constant_rate"})};
  const SelectionCriteria& criteria = bench.problem.criteria;
  const auto all = best_structures(pool, 5, 1e9, criteria);
  REQUIRE(all.size() == 3);
  CHECK(names_in(all[0]) == "constant_rate, sensor_drift");
  CHECK(names_in(all[2]).empty());
  CHECK(best_structures(pool, 2, 1e9, criteria).size() == 2);
  CHECK(best_structures(pool, 5, bench.problem.effort.hopeless, criteria).size() == 1);
  CHECK(best_structures({}, 5, 1e9, criteria).empty());
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

TEST_CASE("the search begins a second time from the nominal parameters, with their weights, and keeps its own") {
  TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.fit.weighting.sigma[0] = 0.001;
  const auto children = extended_from_nominal(search);
  REQUIRE_FALSE(children.empty());
  const EvaluatedHypothesis& best = children[best_of(children, bench.problem.criteria)];
  CHECK(names_in(best) == "constant_rate");
  CHECK(best.loss < 1);  // in units of what the nominal parameters leave
  CHECK(search.problem.fit.weighting.sigma[0] == 0.001);
  search.problem.stopped = [] { return true; };
  CHECK(extended_from_nominal(search).empty());
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
  grow(search, pool);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate, sensor_drift");
  CHECK_FALSE(stages.empty());
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(0.01).epsilon(0.1));

  Search idle = nothing.search();
  std::vector<EvaluatedHypothesis> clean{nothing.with({})};
  int rounds = 0;
  idle.problem.on_progress = [&](const std::string&, double) { ++rounds; };
  grow(idle, clean);
  CHECK(rounds == 1);
  CHECK(names_in(clean[best_of(clean, nothing.problem.criteria)]).empty());
}

TEST_CASE("no structure has more effects than are allowed") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.criteria.max_effects = 1;
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  grow(search, pool);
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

}  // namespace
}  // namespace surefoot::diagnosis
