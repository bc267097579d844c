#include "surefoot/diagnose/log_doctor/constant_stretches.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "surefoot/diagnose/log_doctor/reading_faults.hpp"
#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
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

  TEST_CASE(
      "a coarse sensor that stands still where the machine turns is not stuck, though a model that is off moves on") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    const LogFit fit = fit_log(inputs, log);
    LogFit off = fit;  // in the first recording the model runs ahead by 20 rows
    const Eigen::MatrixXd ahead = fit.runs[0].outputs;
    for (Eigen::Index row = 0; row + 20 < ahead.cols(); ++row) off.runs[0].outputs.col(row) = ahead.col(row + 20);
    off.residuals[0] = off.runs[0].outputs - log[0].outputs;
    const auto with_stretch = [](LogFit some) {
      for (Eigen::Index row = 100; row < 112; ++row) some.bound.recordings[0].outputs(0, row) = 0.1;
      return some;
    };
    const auto found = [&](const LogFit& some) {
      return find_reading_faults(with_stretch(some), inputs.criteria).size();
    };
    const auto stretches = constant_stretches(with_stretch(fit), 0, 0, 1e-4, inputs.criteria);
    REQUIRE(stretches.size() == 1);
    REQUIRE(stretches[0].missed > 2 * fit.typical[0]);
    CHECK(found(fit) == 1);
    CHECK(found(off) == 0);
  }

  TEST_CASE("readings are clipped only where the model goes beyond them by more than it is off") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    const double largest = log[0].outputs.row(0).maxCoeff(), end = 0.7 * largest;
    for (double& reading : log[0].outputs.row(0)) reading = std::min(reading, end);
    LogFit fit = fit_log(inputs, log);
    const auto any_beyond = [&] {
      const auto stretches = constant_stretches(fit, 0, 0, 1e-4, inputs.criteria);
      return std::any_of(stretches.begin(), stretches.end(), [](const ConstantStretch& one) { return one.beyond; });
    };
    CHECK(any_beyond());
    fit.typical[0] = largest;  // such a model may as well be wrong there
    CHECK_FALSE(any_beyond());
  }

  TEST_CASE("what clips more than once is not what a coarse sensor repeats by chance") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    LogFit fit = fit_log(inputs, log);
    auto readings = fit.bound.recordings[0].outputs.row(0);
    const double end = 0.7 * readings.maxCoeff();
    int beyond = 0;  // nine readings at the end in a row, and three more in a row later
    for (double& reading : readings) {
      if (reading <= end) continue;
      ++beyond;
      if (beyond > 9 && (beyond <= 20 || beyond > 23))
        reading = end - 1e-3 - 1e-5 * beyond;
      else
        reading = end;
    }
    REQUIRE(beyond > 23);
    const auto found = find_reading_faults(fit, inputs.criteria);
    REQUIRE(found.size() == 1);
    CHECK(found[0].repairs[0].kind == LogFaultKind::clipped);
    CHECK(found[0].repairs[0].rows.size() == 2);  // both visits are left empty
  }

  TEST_CASE("equal readings in slow motion are as rare as other recordings have them there") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    LogFit fit = fit_log(inputs, toys::servo_log());
    for (std::size_t r = 0; r < fit.runs.size(); ++r) {  // a ramp, read in steps of 0.01, with as much noise
      surefoot::Rng rng(5, r);
      for (Eigen::Index row = 0; row < 300; ++row) {
        const double position = 0.002 * static_cast<double>(row);
        fit.runs[r].outputs(0, row) = position;
        fit.bound.recordings[r].outputs(0, row) = 0.01 * std::round((position + 0.01 * rng.normal()) / 0.01);
      }
    }
    auto readings = fit.bound.recordings[0].outputs.row(0);
    const auto expected = [&](Eigen::Index first, Eigen::Index next) {
      return expected_by_chance(fit, 0, 0, {.rows = {first, next}, .readings = next - first}, 0.02);
    };
    for (Eigen::Index row = 100; row < 104; ++row) readings[row] = readings[99];
    readings[104] = readings[99] + 0.02;
    CHECK(expected(99, 104) > 1);
    for (Eigen::Index row = 100; row < 120; ++row) readings[row] = readings[99];
    readings[120] = readings[99] + 0.05;  // where the model has gone meanwhile
    CHECK(expected(99, 120) < inputs.criteria.significance);
    readings[120] = readings[99];  // a machine that rests
    CHECK(std::isinf(expected(99, 120)));
    readings[120] = readings[99] + 0.05;
    for (std::size_t r = 1; r < fit.runs.size(); ++r) {  // a machine that sticks does so in other recordings as well
      for (Eigen::Index row = 50; row < 250; ++row) {
        if (row % 20 != 0) fit.bound.recordings[r].outputs(0, row) = fit.bound.recordings[r].outputs(0, row - 1);
      }
    }
    CHECK(expected(99, 120) > inputs.criteria.significance);
  }

  TEST_CASE("as many equal readings as a coarse sensor has by chance are no stretch that says anything") {
    const LogDoctorCriteria criteria;
    std::vector<double> lengths(400, 1);
    CHECK(expected_repeats(lengths, 5, 0, criteria) == 0);
    for (const double length : {2, 3, 4})
      lengths.insert(lengths.end(), length == 2 ? 64 : length == 3 ? 12 : 4, length);
    // 80 pairs and 20 further readings: of 100 chances to end there, 20 go on
    CHECK(expected_repeats(lengths, 5, 0, criteria) == doctest::Approx(80 * std::pow(20.0 / 100, 3)));
    lengths.push_back(60);  // that in question
    CHECK(expected_repeats(lengths, 5, 0, criteria) == doctest::Approx(80 * std::pow(20.0 / 100, 3)));
    CHECK(expected_repeats(std::vector<double>(400, 1), 4, 1e-3, criteria) == doctest::Approx(0.4 * 1e-6));
  }
}

}  // namespace
