#include "surefoot/diagnose/log_doctor/log_fit.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
  TEST_CASE("a spoilt recording hardly moves the parameters") {
    auto log = toys::servo_log();
    log[2].outputs *= -50;
    const Parallel parallel = serially();
    const LogFit fit = fit_log(toys::servo_doctor(parallel), log);
    CHECK(fit.hypothesis.parameters[0] == doctest::Approx(90).epsilon(0.02));
    CHECK(fit.hypothesis.parameters[1] == doctest::Approx(8).epsilon(0.02));
    CHECK(fit.error[0] < 0.01);
    CHECK(fit.error[2] > 100);
  }

  TEST_CASE("sizes leave out what was not measured, and what ran away is infinitely far off") {
    Eigen::MatrixXd residuals(1, 3);
    residuals << 3, std::numeric_limits<double>::quiet_NaN(), -3;
    CHECK(mean_square(residuals, Eigen::VectorXd::Constant(1, 3)) == 1);
    residuals(0, 0) = std::numeric_limits<double>::infinity();
    CHECK(std::isinf(mean_square(residuals, Eigen::VectorXd::Constant(1, 3))));
    CHECK(median_of({}) == 0);
    CHECK(median_of({4, 1, 2, 3}) == 2.5);
  }

  TEST_CASE("residuals that change slowly count for few") {
    Eigen::MatrixXd slow(1, 400), fast(1, 400);
    surefoot::Rng rng(3);
    for (Eigen::Index row = 0; row < 400; ++row) {
      slow(0, row) = std::sin(0.02 * static_cast<double>(row));
      fast(0, row) = rng.normal();
    }
    const Eigen::VectorXd unit = Eigen::VectorXd::Ones(1);
    CHECK(independent_share(fast, unit) > 0.9);
    CHECK(independent_share(slow, unit) < 0.05);
  }
}

}  // namespace
