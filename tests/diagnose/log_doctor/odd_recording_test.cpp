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

  TEST_CASE("a recording of another machine is odd, though most of its motion is explained") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    surefoot::Augmented other;
    other.parameters = {115, 10};
    log[2].outputs = simulate_augmented(toys::Servo{}, other, log[2]).outputs;
    const LogFit fit = fit_log(inputs, log);
    CHECK(fit.error[2] < 0.1);
    const auto odd = find_odd_recording(inputs, fit);
    REQUIRE(odd);
    CHECK(odd->recording == 2);
    CHECK(odd->ratio > inputs.criteria.far_off);

    log = toys::servo_log();  // physics that one recording alone shows: its parameters do not make up for it
    surefoot::Augmented stopped;
    stopped.parameters = {90, 8};
    stopped.effects = {{"saturation", "goal", {}, {}, {0.25}}};
    log[2].outputs = simulate_augmented(toys::Servo{}, stopped, log[2]).outputs;
    CHECK_FALSE(find_odd_recording(inputs, fit_log(inputs, log)));
  }

  TEST_CASE("recordings that happen to be hit well do not excuse one that is missed") {
    std::vector<double> errors;
    for (int r = 0; r < 60; ++r) errors.push_back(r % 3 == 0 ? 1e-6 : r % 3 == 1 ? 1e-3 : 2e-3 + 5e-5 * r);
    errors.push_back(1);
    CHECK(error_by_chance(errors, errors.size() - 1) < 1e-4);
    errors.back() = 0.006;
    CHECK(error_by_chance(errors, errors.size() - 1) > 0.01);
    CHECK(error_by_chance({1e-3, 1, 30, 1e-2, 300}, 4) > 1e-3);
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
