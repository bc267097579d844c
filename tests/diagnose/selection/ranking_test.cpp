// Which of the evaluated structures is named, which of a tie comes first, and what an effect gains.
#include "surefoot/diagnose/selection/ranking.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

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
  TankBench bench({});
  bench.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
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

TEST_CASE("where residuals show that something is missing it is named with the odds of a tie already") {
  const TankBench bench({});  // its residuals count as structured
  const double needed = std::log(bench.problem.criteria.tie_odds);
  const auto chosen_with = [&](double log_prior) {
    return ranked(bench.search(), {made_up(bench, {}, 1), made_up(bench, {"sensor_bias"}, 1, log_prior)}).chosen;
  };
  CHECK(names_in(chosen_with(needed + 0.1)) == "sensor_bias");
  CHECK(names_in(chosen_with(needed - 0.1)).empty());
}

TEST_CASE("what residuals show to be missing is named only if one structure stands out against none by itself") {
  const TankBench bench({});  // its residuals count as structured
  const double some = std::log(0.5 * bench.problem.criteria.tie_odds);
  const std::vector<EvaluatedHypothesis> pool{made_up(bench, {}, 1), made_up(bench, {"sensor_bias"}, 1, some),
                                              made_up(bench, {"sensor_drift"}, 1, some),
                                              made_up(bench, {"constant_rate"}, 1, some)};
  CHECK(names_in(ranked(bench.search(), pool).chosen).empty());  // together they have odds of 12
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

TEST_CASE("what was not named may come clearly nearest all the same") {
  const TankBench bench({});
  Selection selection;
  selection.chosen = made_up(bench, {}, 1);
  selection.alternatives = {made_up(bench, {"sensor_bias"}, 0.7), made_up(bench, {"sensor_drift"}, 0.8)};
  CHECK(&clearly_nearest(selection) == &selection.chosen);
  selection.alternatives.push_back(made_up(bench, {"constant_rate"}, 0.5));
  CHECK(names_in(clearly_nearest(selection)) == "constant_rate");
  selection.chosen.errors.mean_squares(0, 0) = 1000;  // a recording that none of them explains hides nothing
  for (EvaluatedHypothesis& one : selection.alternatives) one.errors.mean_squares(0, 0) = 1000;
  selection.alternatives.back().errors.mean_squares.bottomRows(5).setConstant(0.1);
  CHECK(names_in(clearly_nearest(selection)) == "constant_rate");
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

TEST_CASE("a gain in one output counts as that in another, whatever their units") {
  ErrorSquares before{Eigen::MatrixXd(1, 2), Eigen::MatrixXd::Constant(1, 2, 100), Eigen::VectorXd::Ones(2)};
  before.mean_squares << 1e4, 1;
  ErrorSquares after = before;
  after.mean_squares(0, 1) = 0;
  CHECK(gain_of(before, after, 0).gain == doctest::Approx(1 - std::sqrt(0.5)));
  after.mean_squares(0, 0) = 0;
  CHECK(gain_of(before, after, 0).gain == 1);
}

TEST_CASE("of structures that cannot be told apart the closest comes first, if it has no more parameters") {
  TankBench bench({});
  const Search search = bench.search();
  // differences below a standard error do not count in the odds, but in which comes first
  EvaluatedHypothesis far = made_up(bench, {"sensor_bias"}, 1.02), close = made_up(bench, {"sensor_drift"}, 1.0),
                      larger = made_up(bench, {"constant_rate", "sensor_drift"}, 0.9);
  const std::vector<EvaluatedHypothesis> pool{far, close, larger, made_up(bench, {}, 0.5)};
  const double odds = bench.problem.criteria.tie_odds;
  CHECK(closest_of_tie(search, pool, {0.4, 0.3, 0.2, 0.1}, 0) == 1);
  CHECK(closest_of_tie(search, pool, {0.4, 0.4 / (2 * odds), 0.2, 0.1}, 0) == 0);  // no tie
  CHECK(closest_of_tie(search, pool, {0.3, 0.3, 0.4, 0.1}, 2) == 2);
}

TEST_CASE("an effect that may as well be absent is not named") {
  TankBench bench({});
  const Search search = bench.search();
  const EvaluatedHypothesis none = made_up(bench, {}, 9), one = made_up(bench, {"sensor_bias"}, 1),
                            two = made_up(bench, {"sensor_bias", "sensor_drift"}, 1),
                            other_two = made_up(bench, {"sensor_bias", "constant_rate"}, 1),
                            other = made_up(bench, {"constant_rate"}, 1);
  const std::vector<EvaluatedHypothesis> pool{none, one, two, other_two, other};
  CHECK(without_improbable(search, pool, {0, 0.2, 0.45, 0.35, 0}, 2) == 1);   // neither second effect is probable
  CHECK(without_improbable(search, pool, {0, 0.2, 0.6, 0.2, 0}, 2) == 2);     // this one is
  CHECK(without_improbable(search, pool, {0, 0.04, 0.49, 0.47, 0}, 2) == 2);  // the part is not in the tie
  CHECK(without_improbable(search, pool, {0, 0, 0.45, 0.2, 0.35}, 2) == 2);   // nor is another structure a part
  CHECK(without_improbable(search, pool, {0.3, 0, 0.4, 0.3, 0}, 2) == 2);     // whether anything is named is no matter

  // of two that look the same one is needed for what is left to be noise
  bench.problem.noise = Eigen::VectorXd::Constant(1, 0.5);
  const EvaluatedHypothesis noisy = made_up(bench, {"sensor_bias", "sensor_drift"}, 0.5);
  const Search with_noise = bench.search();
  CHECK(without_improbable(with_noise, {none, one, noisy, other_two, other}, {0, 0.2, 0.45, 0.35, 0}, 2) == 2);
}

}  // namespace
}  // namespace surefoot::diagnosis
