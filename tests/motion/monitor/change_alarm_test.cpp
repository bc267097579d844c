#include "surefoot/motion/monitor/change_alarm.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "surefoot/motion/plan/command_plan.hpp"
#include "tests/support/sigmaban_walk.hpp"

using surefoot::AlarmReport;
using surefoot::MotionError;
using surefoot::WalkSequence;

using Alarm = surefoot::ChangeAlarm;

namespace {

std::vector<WalkSequence> wandering(const sigmaban::Model& model, int sequences, std::uint64_t seed) {
  return sigmaban::walked(model, sigmaban::noise(), surefoot::plan_commands({}, sequences, 25, seed), true, seed);
}

/// Calibrated from 25 sequences with every pose, with a threshold that such walks rarely reach.
Alarm calibrated(std::uint64_t seed = 1) {
  const std::vector<WalkSequence> sequences = wandering(sigmaban::model(), 25, seed);
  const auto fit = surefoot::fit_model<sigmaban::Model>(sequences, sigmaban::noise());
  return {.tracker = surefoot::track(fit.model, fit.covariance, sigmaban::noise()), .threshold = 12};
}

}  // namespace

TEST_CASE("a robot that walks as calibrated raises no alarm") {
  Alarm alarm = calibrated();
  for (const WalkSequence& sequence : wandering(sigmaban::model(), 60, 2)) {
    const AlarmReport report = update(alarm, sequence);
    CHECK_FALSE(report.outlier);
    CHECK_FALSE(report.change.has_value());
  }
  CHECK(alarm.recent.size() == 20);
  CHECK(alarm.count == 60);
}

TEST_CASE("a coefficient that jumps by a fifth is noticed within ten sequences, named, and measured") {
  for (const int parameter : {1, 6, 11}) {
    CAPTURE(parameter);
    Alarm alarm = calibrated();
    for (const WalkSequence& sequence : wandering(sigmaban::model(), 15, 3)) update(alarm, sequence);
    std::optional<surefoot::Change> change;
    for (const WalkSequence& sequence : wandering(sigmaban::bent(parameter, 0.8), 10, 4)) {
      change = update(alarm, sequence).change;
    }
    REQUIRE(change.has_value());
    CHECK(change->parameter == parameter);
    CHECK(std::abs(static_cast<double>(change->since) - 16) <= 3);
    const double jump = -0.2 * sigmaban::model().parameters()[parameter];
    CHECK(std::abs(change->jump[parameter] - jump) < 3 * change->standard_error[parameter]);

    adapt(alarm, *change);
    CHECK(alarm.recent.empty());
    const double now = 0.8 * sigmaban::model().parameters()[parameter];
    CHECK(std::abs(alarm.tracker.model.parameters()[parameter] - now) < 3 * alarm.tracker.standard_errors()[parameter]);
    for (const WalkSequence& sequence : wandering(sigmaban::bent(parameter, 0.8), 10, 5)) {
      CHECK_FALSE(update(alarm, sequence).change.has_value());
    }
  }
}

TEST_CASE("one sequence far off is an outlier and no change, and nothing is learnt from it") {
  Alarm alarm = calibrated();
  const surefoot::AnyMotionModel before = alarm.tracker.model;
  std::vector<WalkSequence> sequences = wandering(sigmaban::model(), 21, 6);
  sequences[0].poses.row(0).array() += 1.0;  // the tape began at another mark
  const AlarmReport report = update(alarm, sequences[0]);
  CHECK(report.outlier);
  CHECK_FALSE(report.change.has_value());
  CHECK(alarm.tracker.model.parameters() == before.parameters());
  for (std::size_t i = 1; i < sequences.size(); ++i) CHECK_FALSE(update(alarm, sequences[i]).change.has_value());
}

TEST_CASE("a robot that is quite another raises an alarm at its second sequence, although each is an outlier") {
  Alarm alarm = calibrated();
  const std::vector<WalkSequence> sequences = wandering(sigmaban::bent(11, 0.2), 2, 7);
  const AlarmReport first = update(alarm, sequences[0]);
  CHECK(first.outlier);
  CHECK_FALSE(first.change.has_value());
  CHECK(update(alarm, sequences[1]).change.has_value());
}

TEST_CASE("a change of all coefficients at once is called one of the walk as a whole") {
  surefoot::Vec<12> other = sigmaban::model().parameters();
  surefoot::Rng rng(1);
  for (int i = 0; i < 12; ++i) other[i] += 0.1 * surefoot::parameter_box<sigmaban::Model>().width()[i] * rng.normal();
  Alarm alarm = calibrated();
  std::optional<surefoot::Change> change;
  for (const WalkSequence& sequence : wandering(sigmaban::Model::from_parameters(other), 6, 8)) {
    change = update(alarm, sequence).change;
  }
  REQUIRE(change.has_value());
  CHECK(change->parameter == surefoot::Change::all);
  CHECK(change->since == 1);
  CHECK(describe(*change, sigmaban::model()) == "The walk as a whole changed since sequence 1.");
}

TEST_CASE("a change reads as a sentence with its unit") {
  surefoot::Change change{.parameter = 9, .since = 31};
  change.jump = change.standard_error = Eigen::VectorXd::Zero(12);
  change.jump[9] = 0.26;
  change.standard_error[9] = 0.0512;
  CHECK(describe(change, sigmaban::model()) == "dt per dx changed by 0.26 +- 0.0512 rad/m since sequence 31.");
}

TEST_CASE("wrong options are refused by name, and only changes in the window can be adapted to") {
  Alarm alarm = calibrated();
  const WalkSequence sequence = wandering(sigmaban::model(), 1, 9)[0];
  CHECK_THROWS_AS(adapt(alarm, surefoot::Change{.since = 1}), MotionError);
  alarm.options.window = 1;
  CHECK_THROWS_WITH_AS(update(alarm, sequence), "AlarmOptions: window must be at least 2, got 1", MotionError);
  alarm.options = {.outlier_threshold = 0};
  CHECK_THROWS_AS(update(alarm, sequence), MotionError);
  alarm.options = {.jump_deviation = std::nan("")};
  CHECK_THROWS_AS(update(alarm, sequence), MotionError);
}
