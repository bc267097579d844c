// The search for effects as a whole: with what it ends, and how sure it is of that.
#include "surefoot/diagnose/selection/search.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the search ends with the two effects that act") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const Selection two = bench.found();
  CHECK(names_in(two.chosen) == "constant_rate, sensor_drift");
  CHECK(names_in(two.nominal).empty());
  CHECK(two.probability > 0.9);
  CHECK(two.candidates == 3);
  CHECK(two.fit.recordings == bench.problem.fit.recordings);
  REQUIRE(two.evidence.size() == 2);
  for (std::size_t e = 0; e < 2; ++e) {
    const double without = bench.search().without(two.chosen, e).errors.rms();
    CHECK(two.evidence[e].gain == doctest::Approx(1 - two.chosen.errors.rms() / without).epsilon(0.02));
    CHECK(two.evidence[e].p_value < 1e-3);
  }
  const auto value = [&](const std::string& name) {
    const auto& effects = two.chosen.hypothesis.effects;
    const auto place = std::ranges::find(effects, name, [](const AttachedEffect& one) { return one.effect->name; });
    return two.chosen.hypothesis.values.at(static_cast<std::size_t>(place - effects.begin()))[0];
  };
  CHECK(value("constant_rate") == doctest::Approx(0.2).epsilon(0.1));
  CHECK(value("sensor_drift") == doctest::Approx(0.05).epsilon(0.2));
}

TEST_CASE("probabilities of the choice and of its alternatives add up to 1, the most probable first") {
  const Selection selection = TankBench({rate_in_tank}).found();
  const auto& others = selection.alternative_probabilities;
  CHECK(selection.probability + std::accumulate(others.begin(), others.end(), 0.0) == doctest::Approx(1));
  REQUIRE(others.size() == selection.alternatives.size());
  CHECK(std::ranges::is_sorted(others, std::ranges::greater{}));
  CHECK(names_in(selection.chosen) == "constant_rate");
  for (const EvaluatedHypothesis& one : selection.alternatives) CHECK(names_in(one) != "constant_rate");
}

TEST_CASE("where no effect acts none is chosen") {
  const Selection selection = TankBench({}).found();
  CHECK(names_in(selection.chosen).empty());
  CHECK(selection.evidence.empty());
  CHECK(selection.probability > 0.5);
  CHECK_FALSE(selection.alternatives.empty());  // they were tried
}

TEST_CASE("of residuals that look like noise only strong proposals get a fit") {
  TankBench bench({});
  bench.problem.structured = [](const Hypothesis&, const Integration&) { return false; };
  CHECK(bench.found().alternatives.empty());
  TankBench strong({rate_in_tank});
  strong.problem.structured = [](const Hypothesis&, const Integration&) { return false; };
  CHECK(names_in(strong.found().chosen) == "constant_rate");
}

TEST_CASE("a search that is stopped at once chooses nothing") {
  TankBench bench({rate_in_tank});
  bench.problem.stopped = [] { return true; };
  const Selection selection = bench.found();
  CHECK(names_in(selection.chosen).empty());
  CHECK(selection.probability == doctest::Approx(1));
}

TEST_CASE("effects that are known already are kept, not counted, and not chosen") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.known = 1;
  bench.problem.nominal = bench.start({"constant_rate"});
  const Selection selection = bench.found();
  CHECK(names_in(selection.nominal) == "constant_rate");
  CHECK(names_in(selection.chosen) == "constant_rate, sensor_drift");
  CHECK(selection.evidence.size() == 1);
}

TEST_CASE("the search is the same however its work is shared out") {
  TankBench one({rate_in_tank}), other({rate_in_tank});
  other.parallel = [](std::size_t count, const std::function<void(std::size_t)>& job) {
    for (std::size_t i = count; i > 0; --i) job(i - 1);
  };
  const Selection a = one.found(), b = other.found();
  CHECK(a.probability == b.probability);
  CHECK(a.alternative_probabilities == b.alternative_probabilities);
  CHECK(a.chosen.hypothesis.values == b.chosen.hypothesis.values);
}

TEST_CASE("a search in many recordings looks at some that differ, and fits to all what it finds") {
  TankBench bench({rate_in_tank});
  bench.problem.screened = {0, 1};
  const Hypothesis nominal = bench.problem.nominal;
  CHECK(informative(bench.bound, nominal, bench.problem, bench.parallel) == bench.problem.fit.recordings);
  bench.problem.effort.rows = 400;
  const auto some = informative(bench.bound, nominal, bench.problem, bench.parallel);
  CHECK(some.size() == 4);
  CHECK(std::ranges::is_sorted(some));
  bench.problem.effort.rows = 1;
  CHECK(informative(bench.bound, nominal, bench.problem, bench.parallel).size() == 2);  // as many as are screened
  const Selection selection = bench.found();
  CHECK(names_in(selection.chosen) == "constant_rate");
  CHECK(selection.fit.recordings.size() == 6);
  CHECK(selection.chosen.errors.mean_squares.rows() == 6);
  CHECK(selection.nominal.errors.mean_squares.rows() == 6);
}

// A structure with these mean squares in recordings of 100 cells.
EvaluatedHypothesis made_up(const TankBench& bench, const std::vector<std::string>& names, double mean_square,
                            double log_prior = 0) {
  EvaluatedHypothesis one;
  one.hypothesis = bench.start(names);
  one.errors = {Eigen::MatrixXd::Constant(6, 1, mean_square), Eigen::MatrixXd::Constant(6, 1, 100),
                Eigen::VectorXd::Ones(1)};
  one.log_prior = log_prior;
  return one;
}

TEST_CASE("the most probable structure is named if its odds against none are high enough") {
  const TankBench bench({});
  const SelectionCriteria& criteria = bench.problem.criteria;
  const double needed = std::log(criteria.named_odds);
  const auto chosen_with = [&](double log_prior) {
    return ranked(bench.search(), {made_up(bench, {}, 1), made_up(bench, {"sensor_bias"}, 1, log_prior)});
  };
  const Selection named = chosen_with(needed + 0.1), unsure = chosen_with(needed - 0.1);
  CHECK(names_in(named.chosen) == "sensor_bias");
  CHECK(named.probability > criteria.named_odds / (1 + criteria.named_odds));
  CHECK(names_in(unsure.chosen).empty());
  CHECK(unsure.probability < 0.5);  // though it is less probable than the effect
  REQUIRE(unsure.alternatives.size() == 1);
  CHECK(names_in(unsure.alternatives[0]) == "sensor_bias");
}

TEST_CASE("all that was evaluated is ranked, whatever way led to it") {
  const TankBench bench({});
  const Selection selection = ranked(
      bench.search(), {made_up(bench, {"sensor_bias"}, 2), made_up(bench, {}, 9),
                       made_up(bench, {"constant_rate", "sensor_drift"}, 1), made_up(bench, {"sensor_drift"}, 3)});
  CHECK(names_in(selection.nominal).empty());
  CHECK(names_in(selection.chosen) == "constant_rate, sensor_drift");
  REQUIRE(selection.alternatives.size() == 3);
  CHECK(names_in(selection.alternatives[0]) == "sensor_bias");
  CHECK(selection.candidates == 3);
}

TEST_CASE("a gain is the share of the error that goes, and its standard error that over recordings") {
  ErrorSquares before{Eigen::MatrixXd::Constant(4, 1, 4), Eigen::MatrixXd::Constant(4, 1, 100),
                      Eigen::VectorXd::Ones(1)};
  ErrorSquares after = before;
  after.mean_squares.setConstant(1);
  const Comparison even = gain_of(before, after, 0);
  CHECK(even.gain == doctest::Approx(0.5));
  CHECK(even.stderr_ == doctest::Approx(0));
  CHECK(even.p_value == doctest::Approx(0.5));
  after.mean_squares.col(0) << 0.6, 1.4, 0.6, 1.4;
  const Comparison uneven = gain_of(before, after, std::log(99));
  CHECK(uneven.gain == doctest::Approx(0.5));
  // ratio of the squares 1/4, with a standard error of sqrt(4) 100 * 0.4 / 1600; that of its root is the same, as 2 *
  // 1/2
  CHECK(uneven.stderr_ == doctest::Approx(0.05));
  CHECK(uneven.t == doctest::Approx(10));
  CHECK(uneven.p_value == doctest::Approx(0.01));
  CHECK(gain_of(before, after, 1e9).p_value >= 0);
  CHECK(gain_of(before, after, -1e9).p_value <= 1);
  before.mean_squares.setZero();
  CHECK(gain_of(before, after, 5).p_value == 1);  // there was nothing to gain
}

}  // namespace
}  // namespace surefoot::diagnosis
