#include "surefoot/diagnose/log_doctor/odd_recording.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
  TEST_CASE("a recording with the commands of another is odd, one that is just missed by more is not") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    CHECK_FALSE(find_odd_recording(inputs, fit_log(inputs, log)));
    log[4].inputs = -log[0].inputs;
    const auto odd = find_odd_recording(inputs, fit_log(inputs, log));
    REQUIRE(odd);
    CHECK(odd->recording == 4);
    CHECK(odd->ratio > 2);
  }

  TEST_CASE("three recordings do not say what most are like") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log({}, 3);
    log[2].inputs *= -1;
    CHECK_FALSE(find_odd_recording(inputs, fit_log(inputs, log)));
  }
}

}  // namespace
