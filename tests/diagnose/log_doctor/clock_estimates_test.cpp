#include "surefoot/diagnose/log_doctor/clock_estimates.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
  TEST_CASE("clocks are estimated with a standard error, between the amounts that are tried") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    toys::delay_outputs(log[1], 0.04);
    log[2].time *= 1.017;
    const LogFit fit = fit_log(inputs, log);
    const ClockEstimate late = clock_estimate(clock_profile(fit, 1, LogFaultKind::offset, inputs.criteria));
    REQUIRE(late.usable);
    CHECK(late.value == doctest::Approx(0.04).epsilon(0.05));
    CHECK(std::sqrt(late.variance) < 0.004);
    const ClockEstimate fast = clock_estimate(clock_profile(fit, 2, LogFaultKind::time_skew, inputs.criteria));
    REQUIRE(fast.usable);
    CHECK(fast.value == doctest::Approx(0.017).epsilon(0.2));
  }

  TEST_CASE("the better the model fits, the closer amounts are tried: no error is made up between them") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    for (auto& recording : log) {  // without noise, one percent off is a great deal
      surefoot::Augmented machine;
      machine.parameters = {90, 8};
      recording.outputs = simulate_augmented(toys::Servo{}, machine, recording).outputs;
    }
    const LogFit fit = fit_log(inputs, log);
    for (std::size_t r = 0; r < log.size(); ++r) {
      const ClockProfile profile = clock_profile(fit, r, LogFaultKind::time_skew, inputs.criteria);
      const ClockEstimate exact = clock_estimate(profile);
      REQUIRE(exact.usable);
      CHECK(exact.error >= 0);
      CHECK(std::abs(exact.value) < 1e-4);
    }
  }

  TEST_CASE("an error without a minimum within the range tells nothing") {
    ClockProfile profile{{-1, 0, 1}, Eigen::MatrixXd::Ones(4, 3), Eigen::MatrixXd::Ones(4, 3)};
    profile.squares.col(2).setConstant(0.5);
    CHECK_FALSE(clock_estimate(profile).usable);
    profile.squares.col(1).setConstant(0.25);
    CHECK(clock_estimate(profile).usable);
    CHECK(error_at(profile, 0) == doctest::Approx(0.25));
    CHECK(error_at(profile, 1) == doctest::Approx(0.5));
  }
}

}  // namespace
