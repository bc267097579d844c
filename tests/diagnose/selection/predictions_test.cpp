// What structures predict of recordings that they were not fitted to.
#include "surefoot/diagnose/selection/predictions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

/// Whose recordings are predicted from those of other folds, two at a time.
struct FoldedBench : TankBench {
  explicit FoldedBench(const std::vector<NamedEffect>& truth) : TankBench(truth) {
    problem.folds = {{0, 1}, {2, 3}, {4, 5}};
  }
};

TEST_CASE("what all recordings share is predicted as well as it is fitted") {
  const FoldedBench bench({drift_in_tank});
  const EvaluatedHypothesis drift = bench.with({"sensor_drift"});
  const ErrorSquares unseen = errors_of_predictions(bench.search(), drift);
  CHECK(unseen.rms() >= drift.errors.rms());
  CHECK(unseen.rms() < 1.1 * drift.errors.rms());
}

TEST_CASE("what two recordings have for themselves is fitted in part, and predicted of none") {
  FoldedBench bench({});
  for (const std::size_t r : {0, 1}) bench.bound.recordings[r].outputs.array() += 0.3;
  const EvaluatedHypothesis bias = bench.with({"sensor_bias"});
  const ErrorSquares unseen = errors_of_predictions(bench.search(), bias);
  CHECK(unseen.rms() > 1.2 * bias.errors.rms());
  for (const Eigen::Index r : {0, 1}) CHECK(unseen.mean_squares(r, 0) > 1.1 * bias.errors.mean_squares(r, 0));
}

TEST_CASE("where more than noise is left structures are measured by their predictions") {
  FoldedBench bench({drift_in_tank});
  bench.problem.least = Eigen::VectorXd::Constant(1, 1e3);
  const std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift"}),
                                              bench.with({"constant_rate"})};
  const auto weighed = with_predictions(bench.search(), pool);  // residuals of a bench count as structured
  REQUIRE(weighed.size() >= 2);
  CHECK(names_in(weighed.front()) == "sensor_drift");
  for (const EvaluatedHypothesis& one : weighed) {
    CHECK(one.errors.rms() == doctest::Approx(one.predicted));
    CHECK(one.errors.least[0] <= one.predicted * one.predicted * (1 + 1e-9));  // no error of form is larger
  }
  bench.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  const auto as_fitted = with_predictions(bench.search(), pool);
  CHECK(as_fitted.size() == 3);
  CHECK(std::isnan(as_fitted[2].predicted));  // it is no tie
  for (const EvaluatedHypothesis& one : as_fitted) {
    if (std::isnan(one.predicted)) continue;
    const auto same = std::find_if(pool.begin(), pool.end(),
                                   [&](const EvaluatedHypothesis& other) { return names_in(other) == names_in(one); });
    CHECK(one.errors.rms() == same->errors.rms());
    CHECK(one.predicted >= one.errors.rms());
  }
}

TEST_CASE("without folds, or without time, all is as it was fitted") {
  FoldedBench bench({drift_in_tank});
  const std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift"})};
  bench.problem.stopped = [] { return true; };
  const auto late = with_predictions(bench.search(), pool);
  REQUIRE(late.size() == 2);
  CHECK(std::isnan(late[0].predicted));
  bench.problem.stopped = [] { return false; };
  bench.problem.folds = {{0, 1, 2, 3, 4, 5}};
  const auto single = with_predictions(bench.search(), pool);
  REQUIRE(single.size() == 2);
  CHECK(std::isnan(single[1].predicted));
}

TEST_CASE("a selection gets the errors of its fits back") {
  const FoldedBench bench({drift_in_tank});
  const std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift"})};
  Selection selection = ranked(bench.search(), with_predictions(bench.search(), pool));
  REQUIRE(names_in(selection.chosen) == "sensor_drift");
  restore_errors_of_fits(selection, pool);
  CHECK(selection.chosen.errors.rms() == pool[1].errors.rms());
  CHECK(selection.nominal.errors.rms() == pool[0].errors.rms());
  CHECK(std::isfinite(selection.chosen.predicted));
}

}  // namespace
}  // namespace surefoot::diagnosis
