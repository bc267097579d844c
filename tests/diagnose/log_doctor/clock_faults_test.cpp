#include "surefoot/diagnose/log_doctor/clock_faults.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

std::vector<ClockEstimate> estimates(const std::vector<double>& values, double variance) {
  std::vector<ClockEstimate> list;
  for (const double value : values) list.push_back({true, value, variance, 1});
  return list;
}

TEST_SUITE("log_doctor") {
  TEST_CASE("clocks scatter by chance as far as their standard errors say") {
    CHECK(scatter_by_chance(estimates({1, -1, 0.5, -0.5}, 1), {}) > 0.1);
    CHECK(scatter_by_chance(estimates({10, -10, 5, -5}, 1), {}) < 1e-6);
  }

  TEST_CASE("one clock is off if the others agree") {
    CHECK(outlier_by_chance(estimates({0, 0.1, -0.1, 0.05, -0.05, 5}, 0.01), 5, {}) < 1e-5);
    CHECK(outlier_by_chance(estimates({0, 4, -3, 2, -5, 5}, 0.01), 5, {}) > 0.05);
    // others that agree better than they are known do not make it any surer
    CHECK(outlier_by_chance(estimates({0, 0, 0, 0, 0, 3}, 1), 5, {}) > 0.01);
  }

  TEST_CASE("a recording that the model misses says little about clocks") {
    auto clocks = estimates({0.001, 0, -0.001, 0.001, -0.001, 0, 0.017, 0.025}, 1e-6);
    CHECK(outlier_by_chance(clocks, 7, {}) > 1e-3);  // another clock is as far off
    clocks[6].error = 200;
    CHECK(outlier_by_chance(clocks, 7, {}) < 1e-5);
  }

  TEST_CASE("a clock that leaves its recording far worse than all others is not what is wrong with it") {
    auto clocks = estimates({0, 0.1, -0.1, 5}, 0.01);
    CHECK(is_like_others(clocks, 3, {}));
    clocks[3].error = 5;
    CHECK_FALSE(is_like_others(clocks, 3, {}));
    clocks[0].error = 2;
    CHECK(is_like_others(clocks, 3, {}));
  }

  TEST_CASE("clocks of a map or of too few recordings are not compared") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    CHECK(has_clocks(fit_log(inputs, toys::servo_log({}, 3)), inputs.criteria));
    CHECK_FALSE(has_clocks(fit_log(inputs, toys::servo_log({}, 2)), inputs.criteria));
  }

  TEST_CASE("a delay that all recordings share is physics") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    for (auto& recording : log) toys::delay_outputs(recording, 0.06);
    CHECK_FALSE(find_clock_fault(inputs, fit_log(inputs, log)));
    toys::delay_outputs(log[0], 0.06);
    const auto found = find_clock_fault(inputs, fit_log(inputs, log));
    REQUIRE(found);
    CHECK(found->kind == LogFaultKind::offset);
    CHECK(found->amounts[0] == doctest::Approx(0.06).epsilon(0.1));
  }
}

}  // namespace
