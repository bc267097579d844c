#include "surefoot/diagnose/log_doctor/reading_faults.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
  TEST_CASE("a sensor's resolution is the smallest step of its readings") {
    auto log = toys::servo_log({}, 2);
    for (auto& recording : log) {
      for (double& value : recording.outputs.row(0)) value = 0.01 * std::round(value / 0.01);
    }
    CHECK(resolution_of(log, 0) == doctest::Approx(0.01));
  }

  TEST_CASE("equal readings are a stretch if the model moves on by more than the resolution") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    for (Eigen::Index row = 100; row < 130; ++row) log[0].outputs(0, row) = log[0].outputs(0, 99);
    const LogFit fit = fit_log(inputs, log);
    const auto stretches = constant_stretches(fit, 0, 0, 1e-4, inputs.criteria);
    REQUIRE(stretches.size() == 1);
    CHECK(stretches[0].rows.first == 99);
    CHECK(stretches[0].rows.second == 130);
    CHECK(constant_stretches(fit, 0, 0, 10, inputs.criteria).empty());
    CHECK(constant_stretches(fit, 1, 0, 1e-4, inputs.criteria).empty());
  }

  TEST_CASE("a gap is a gap only where other intervals are short") {
    auto log = toys::servo_log({}, 2);
    CHECK(find_gaps(bind_simulator(toys::Servo{}, log), {}).empty());
    log[1].time.tail(100).array() += 0.5;
    const auto gaps = find_gaps(bind_simulator(toys::Servo{}, log), {});
    REQUIRE(gaps.size() == 1);
    CHECK(*gaps[0].recording == 1);
    CHECK(gaps[0].repairs[0].rows[0] == RowRange{199, 200});
  }

  TEST_CASE("end stops and stiction that all recordings show are the machine") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    for (auto& recording : log) {
      for (double& value : recording.outputs.row(0)) value = std::clamp(value, -0.25, 0.25);
    }
    CHECK(find_reading_faults(fit_log(inputs, log), inputs.criteria).empty());
  }
}

}  // namespace
