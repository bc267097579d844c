#include "surefoot/motion/monitor/alarm_threshold.hpp"

#include <doctest/doctest.h>

#include <span>
#include <vector>

#include "surefoot/motion/plan/command_plan.hpp"
#include "tests/support/sigmaban_walk.hpp"

using surefoot::ThresholdOptions;
using surefoot::WalkSequence;

namespace {

std::vector<WalkSequence> wandering(const sigmaban::Model& model, int sequences, int cycles, std::uint64_t seed) {
  return sigmaban::walked(model, sigmaban::noise(), surefoot::plan_commands({}, sequences, cycles, seed), true, seed);
}

surefoot::MotionTracker calibrated(std::span<const WalkSequence> sequences) {
  const auto fit = surefoot::fit_model<sigmaban::Model>(sequences, sigmaban::noise());
  return surefoot::track(fit.model, fit.covariance, sigmaban::noise());
}

}  // namespace

TEST_CASE("the threshold is the same for any number of threads, and higher if the noise is not well known") {
  const std::vector<WalkSequence> sequences = wandering(sigmaban::model(), 25, 6, 1);
  const auto tracker = calibrated(sequences);
  ThresholdOptions options{.false_alarms = 0.1, .run_length = 20, .runs = 30};
  const double serial = surefoot::alarm_threshold(tracker, sequences, options, surefoot::Serial(), 1);
  CHECK(serial == surefoot::alarm_threshold(tracker, sequences, options, surefoot::Threads(3), 1));
  CHECK(serial != surefoot::alarm_threshold(tracker, sequences, options, surefoot::Serial(), 2));
  options.noise_error = 0.3;
  CHECK(serial < surefoot::alarm_threshold(tracker, sequences, options, surefoot::Serial(), 1));
}

TEST_CASE("a threshold keeps its share of false alarms, and a jump by a fifth is noticed within ten sequences") {
  const std::vector<WalkSequence> sequences = wandering(sigmaban::model(), 25, 25, 1);
  const auto tracker = calibrated(sequences);
  const ThresholdOptions options{.false_alarms = 0.05, .runs = 90};
  const double threshold = surefoot::alarm_threshold(tracker, sequences, options, surefoot::Threads(), 1);
  const surefoot::ChangeAlarm fresh{.tracker = tracker, .threshold = threshold};

  int false_alarms = 0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    auto alarm = fresh;
    bool raised = false;
    for (const WalkSequence& sequence : wandering(sigmaban::model(), 100, 25, 100 + run)) {
      raised = raised || update(alarm, sequence).change.has_value();
    }
    false_alarms += raised ? 1 : 0;
  }
  CHECK(false_alarms <= 3);  // 1 expected

  int noticed = 0;
  for (const int parameter : {1, 6, 11}) {
    for (std::uint64_t run = 0; run < 10; ++run) {
      auto alarm = fresh;
      bool raised = false;
      for (const WalkSequence& sequence :
           wandering(sigmaban::bent(parameter, run % 2 == 0 ? 1.2 : 0.8), 10, 25, 200 + run)) {
        raised = raised || update(alarm, sequence).change.has_value();
      }
      noticed += raised ? 1 : 0;
    }
  }
  CHECK(noticed >= 28);  // of 30
}

TEST_CASE("a rank is safe if it is the largest that holds with the confidence asked for") {
  CHECK(surefoot::detail::safe_rank(229, 0.01, 0.9) == 0);  // 0.99^229 = 0.1001
  CHECK(surefoot::detail::safe_rank(230, 0.01, 0.9) == 1);
  CHECK(surefoot::detail::safe_rank(1000, 0.01, 0.9) == 6);  // binomial: at most 5 with 0.066, at most 6 with 0.129
}

TEST_CASE("wrong options are refused by name") {
  const std::vector<WalkSequence> sequences = wandering(sigmaban::model(), 25, 6, 1);
  const auto tracker = calibrated(sequences);
  const auto message = [&](const ThresholdOptions& options) {
    try {
      surefoot::alarm_threshold(tracker, sequences, options, surefoot::Serial(), 1);
    } catch (const surefoot::MotionError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message({.false_alarms = 1}) == "ThresholdOptions: false_alarms must be in (0, 1), got 1");
  CHECK(message({.run_length = 0}) == "ThresholdOptions: run_length must be at least 1, got 0");
  CHECK(message({.runs = 100}) == "ThresholdOptions: runs must be at least 230, got 100");
  CHECK(message({.noise_error = -1}) == "ThresholdOptions: noise_error must be a finite number from 0 on, got -1");
}
