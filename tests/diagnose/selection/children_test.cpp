// Children of a structure: fits of what is proposed, one by one and in pairs.
#include "surefoot/diagnose/selection/children.hpp"

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

TEST_CASE(
    "signatures that the parameters of the model can make as well are not proposed, unless the rest is worth it") {
  TankBench bench({rate_in_tank});
  const auto all = proposals_without_effects(bench);
  REQUIRE(all.size() > 1);
  bench.problem.criteria.least_distinct = 2;  // more than all of it
  bench.problem.criteria.structure_share = all.back().gain;
  const auto worth = proposals_without_effects(bench);
  REQUIRE(worth.size() < all.size());
  CHECK(worth.front().effect.effect->name == "constant_rate");
  bench.problem.criteria.structure_share = 1;
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

TEST_CASE("what cannot grow from nothing goes on from the start that leaves least when all else is settled") {
  const TankBench bench({rate_in_tank});
  Effect valley = effects::constant_rate();  // at 0.2, of which nothing is seen from below 0.1
  valley.parameters[0].strength = false;
  valley.force = [](const EffectContext&, Values p, Values) { return p[0] < 0.1 ? 0.0 : p[0]; };
  Proposal one = proposals_without_effects(bench).at(0);
  one.effect.effect = std::make_shared<const Effect>(valley);
  const auto fitted_from = [&](double start, double other) {
    one.start[0] = start;
    one.more_starts = {one.start};
    one.more_starts[0][0] = other;
    return fit_child(bench.bound, bench.with({}).hypothesis, {one}, bench.problem);
  };
  for (const Fit& fitted : {fitted_from(0.05, 0.3), fitted_from(0.3, 0.05)}) {
    REQUIRE(fitted.ok);
    CHECK(fitted.hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
  }
}

TEST_CASE("of all children the best are finished, and what cannot be simulated is given up") {
  const TankBench bench({rate_in_tank});
  std::vector<std::vector<Proposal>> additions{{explosion()}};
  for (const Proposal& one : proposals_without_effects(bench)) additions.insert(additions.begin(), {one});
  REQUIRE(additions.size() == 4);
  const auto all = evaluate_children(bench.search(), bench.with({}), additions, 10);
  REQUIRE(all.size() == 3);
  CHECK(names_in(all[best_of(all, bench.problem.criteria)]) == "constant_rate");
  const auto one = evaluate_children(bench.search(), bench.with({}), additions, 1);
  REQUIRE(one.size() == 1);
  CHECK(names_in(one[0]) == "constant_rate");
  CHECK(finished(bench.search(), {}, 3).empty());
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
  const auto pairs = next_pairs(search, none, proposals, 0);
  REQUIRE_FALSE(pairs.empty());
  CHECK(pairs.size() <= bench.problem.effort.pair_finalists);
  CHECK(names_in(pairs[best_of(pairs, bench.problem.criteria)]) == "constant_rate, sensor_drift");
}

TEST_CASE("what a further effect must explain grows with how far its parent is behind the best structure") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const Search search = bench.search();
  const EvaluatedHypothesis both = bench.with({"constant_rate", "sensor_drift"}), none = bench.with({});
  const double beside_best = needed_gain(search, both, both, 1), beside_none = needed_gain(search, none, both, 1);
  CHECK(beside_best >= 0);
  CHECK(beside_best < 0.1);
  CHECK(beside_none > 0.5);
  CHECK(beside_none < 1);
  CHECK(needed_gain(search, both, both, 4) > beside_best);
}

TEST_CASE("proposals that cannot pay get no fit, alone or in pairs") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const Search search = bench.search();
  std::vector<Proposal> gains(3);
  for (std::size_t i = 0; i < gains.size(); ++i) gains[i].gain = std::vector<double>{0.5, 0.05, 0.01}[i];
  drop_what_cannot_pay(gains, 0.2, SearchEffort{});
  CHECK(gains.size() == 2);
  const EvaluatedHypothesis none = bench.with({});
  CHECK(next_pairs(search, none, proposals_for(search, none), 10).empty());
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

TEST_CASE("the best single effects are tried with each other, though neither may be the best alone") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const std::vector<EvaluatedHypothesis> singles{bench.with({}), bench.with({"sensor_bias"}),
                                                 bench.with({"sensor_drift"}), bench.with({"constant_rate"})};
  const auto pairs = combined(bench.search(), singles);
  REQUIRE_FALSE(pairs.empty());
  for (const EvaluatedHypothesis& one : pairs) CHECK(one.hypothesis.effects.size() == 2);
  CHECK(names_in(pairs[best_of(pairs, bench.problem.criteria)]) == "constant_rate, sensor_drift");
  CHECK(combined(bench.search(), {bench.with({"constant_rate"})}).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis
