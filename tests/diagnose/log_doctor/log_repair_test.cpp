#include "surefoot/diagnose/log_doctor/log_repair.hpp"

#include <doctest/doctest.h>

#include <set>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
  TEST_CASE("every column may have another sign, angles another unit, columns of one side or unit each other's place") {
    std::multiset<std::string> kinds;
    for (const LogRepair& repair : column_repairs(toys::Servo{}.info())) kinds.insert(name_of(repair.kind));
    CHECK(kinds.count("sign_flipped") == 3);
    CHECK(kinds.count("angle_unit") == 3);
    CHECK(kinds.count("columns_swapped") == 2);  // both outputs; goal and angle
  }

  TEST_CASE("an initial state that was read off an output follows its repair") {
    auto log = toys::servo_log();
    log[0].outputs(0, 0) = log[0].initial[0] = 0.3;
    const BoundSimulator bound = bind_simulator(toys::Servo{}, log);
    const auto flipped = repaired(bound, log[0], {.kind = LogFaultKind::sign, .amount = -1});
    CHECK(flipped.initial[0] == -0.3);
    CHECK(flipped.outputs(0, 100) == -log[0].outputs(0, 100));
    CHECK(flipped.outputs(1, 100) == log[0].outputs(1, 100));
  }

  TEST_CASE("late outputs are read between rows, and nothing is made up beyond the last") {
    auto log = toys::servo_log();
    for (Eigen::Index row = 0; row < 300; ++row) log[0].outputs(0, row) = log[0].time[row];
    const BoundSimulator bound = bind_simulator(toys::Servo{}, log);
    const auto shifted = repaired(bound, log[0], {.kind = LogFaultKind::offset, .amount = 0.025});
    CHECK(shifted.outputs(0, 100) == doctest::Approx(1.025));
    CHECK(std::isnan(shifted.outputs(0, 298)));
    const auto scaled = repaired(bound, log[0], {.kind = LogFaultKind::output_skew, .amount = 0.02});
    CHECK(scaled.outputs(0, 100) == doctest::Approx(1.02));
  }

  TEST_CASE("times are scaled about the first, and rows of a fault become empty") {
    auto log = toys::servo_log();
    const BoundSimulator bound = bind_simulator(toys::Servo{}, log);
    const auto seconds = repaired(bound, log[0], {.kind = LogFaultKind::time_unit, .amount = 1e-3});
    CHECK(seconds.time[100] == doctest::Approx(1e-3));
    const auto slower = repaired(bound, log[0], {.kind = LogFaultKind::time_skew, .amount = 0.25});
    CHECK(slower.time[100] == doctest::Approx(0.8));
    const auto emptied = repaired(bound, log[0], {.kind = LogFaultKind::stuck, .rows = {{3, 5}}});
    CHECK(std::isnan(emptied.outputs(0, 4)));
    CHECK(std::isfinite(emptied.outputs(0, 5)));
    CHECK(std::isfinite(emptied.outputs(1, 4)));
  }
}

}  // namespace
