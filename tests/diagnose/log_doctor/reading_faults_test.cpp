#include "surefoot/diagnose/log_doctor/reading_faults.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

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

  TEST_CASE("rows that a regular clock left out are counted") {
    const auto without = [](const std::vector<int>& lost) {
      std::vector<double> time;
      for (int row = 0; row < 400; ++row) {
        if (std::find(lost.begin(), lost.end(), row) == lost.end()) time.push_back(0.05 * row);
      }
      surefoot::Recording recording;
      recording.time = Eigen::Map<Eigen::VectorXd>(time.data(), static_cast<Eigen::Index>(time.size()));
      return recording;
    };
    CHECK(lost_rows(without({})) == 0);
    CHECK(lost_rows(without({10, 20, 21})) == 3);
    surefoot::Recording late = without({10});
    late.time[50] += 0.03;  // alone: the next row is where it should be
    CHECK(lost_rows(late) == 1);
    std::vector<int> every_third;
    for (int row = 3; row < 400; row += 3) every_third.push_back(row);
    CHECK(lost_rows(without(every_third)) == 0);  // its clock is not regular
  }

  TEST_CASE("equal readings of a noisy sensor are no sign of dropped samples where the model moves by less than that") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const LogFit fit = fit_log(inputs, toys::servo_log({}));  // noise of 0.002 rad and 0.02 rad/s
    CHECK(motion_that_shows(fit, 0, 0.0001) == doctest::Approx(3 * 0.002).epsilon(0.1));
    CHECK(motion_that_shows(fit, 1, 0.0001) == doctest::Approx(3 * 0.02).epsilon(0.1));
    CHECK(motion_that_shows(fit, 0, 0.1) == 0.2);
  }

  TEST_CASE("a sensor with more noise than its steps does not repeat itself, and samples that do are made up for") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    surefoot::Rng rng(5);
    for (surefoot::Recording& recording : log) {
      for (double& reading : recording.outputs.row(0))
        reading = 0.01 * std::round((reading + 0.02 * rng.normal()) / 0.01);
    }
    const auto found_in = [&](const std::vector<surefoot::Recording>& some) {
      return find_reading_faults(fit_log(inputs, some), inputs.criteria);
    };
    CHECK(found_in(log).empty());
    auto resting = log, dropped = log;
    for (Eigen::Index row = 1; row < 300; ++row) {
      if (!(rng.uniform() < 0.4)) continue;
      dropped[2].outputs(0, row) = dropped[2].outputs(0, row - 1);
      if (row >= 250) resting[2].outputs(0, row) = resting[2].outputs(0, row - 1);  // little moves then
    }
    const auto found = found_in(dropped);
    REQUIRE(found.size() == 1);
    CHECK(*found[0].recording == 2);
    CHECK(found[0].repairs[0].kind == LogFaultKind::repeated);
    CHECK(found_in(resting).empty());
  }

  TEST_CASE("a speed that reads nothing while the position rests is no stuck sensor, whatever comes next") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    LogFit fit = fit_log(inputs, toys::servo_log());
    auto& readings = fit.bound.recordings[0].outputs;
    constexpr Eigen::Index first = 112, last = 126;
    const Eigen::MatrixXd moving = readings;
    for (Eigen::Index row = first; row < last; ++row) readings(1, row) = 0.02;
    const auto stuck = find_reading_faults(fit, inputs.criteria);
    REQUIRE(stuck.size() == 1);
    CHECK(stuck[0].repairs.front().kind == LogFaultKind::stuck);
    for (Eigen::Index row = first; row < last; ++row) {
      readings(0, row) = moving(0, first) + 0.002 * (row % 2 == 0 ? 1 : -1);
    }
    CHECK(find_reading_faults(fit, inputs.criteria).empty());
  }

  TEST_CASE("where all sensors stand still in the same rows, samples were dropped") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const auto kinds = [&](bool all) {
      auto log = toys::servo_log();
      for (Eigen::Index row = 112; row < 140; ++row) {
        log[0].outputs(0, row) = log[0].outputs(0, 111);
        if (all) log[0].outputs(1, row) = log[0].outputs(1, 111);
      }
      std::vector<LogFaultKind> found;
      for (const FoundFault& fault : find_reading_faults(fit_log(inputs, log), inputs.criteria)) {
        CHECK(*fault.recording == 0);
        found.push_back(fault.repairs.front().kind);
        if (all) CHECK(fault.repairs.front().rows.size() == 28);
      }
      return found;
    };
    CHECK(kinds(false) == std::vector{LogFaultKind::stuck});
    CHECK(kinds(true) == std::vector{LogFaultKind::repeated, LogFaultKind::repeated});
  }

  TEST_CASE("what stands at the end of its range and leaves it again has reached a limit, and is not stuck") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    LogFit fit = fit_log(inputs, toys::servo_log());
    Eigen::Index top = 0;
    const double largest = fit.bound.recordings[0].outputs.row(0).maxCoeff(&top);
    const auto found_between = [&](Eigen::Index from, Eigen::Index to) {
      LogFit some = fit;
      for (Eigen::Index row = from; row < to; ++row) {  // the model moves below
        some.bound.recordings[0].outputs(0, row) = largest;
        some.runs[0].outputs(0, row) = largest - 0.05 * static_cast<double>(row - from + 1);
      }
      return find_reading_faults(some, inputs.criteria).size();
    };
    const Eigen::Index rows = fit.bound.recordings[0].rows();
    REQUIRE((top > 6 && top + 12 < rows));
    CHECK(found_between(top - 6, top + 6) == 1);      // without the noise of all other readings
    for (Eigen::Index row = 100; row < 104; ++row) {  // a sensor that reads the same at rest
      fit.runs[1].outputs(0, row) = fit.bound.recordings[1].outputs(0, row) = 0.2;
    }
    CHECK(found_between(top - 6, top + 6) == 0);
    CHECK(found_between(rows - 12, rows) == 1);  // it never comes back
  }

  TEST_CASE("a sensor that stood at its largest reading is stuck if it goes on from where the machine is by then") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const LogFit fit = fit_log(inputs, toys::servo_log());
    const auto kind_of = [&](const LogFit& some) {
      const auto found = find_reading_faults(some, inputs.criteria);
      REQUIRE(found.size() == 1);
      return found[0].repairs.front().kind;
    };
    LogFit stuck = fit, clipped = fit;
    Eigen::Index top = 0;
    const auto readings = fit.bound.recordings[0].outputs.row(0);
    const double largest = readings.maxCoeff(&top);
    Eigen::Index next = top + 8;
    while (readings[next] > largest - 0.15) ++next;
    for (Eigen::Index row = top; row < next; ++row) stuck.bound.recordings[0].outputs(0, row) = largest;
    CHECK(kind_of(stuck) == LogFaultKind::stuck);
    for (double& reading : clipped.bound.recordings[0].outputs.row(0)) reading = std::min(reading, largest - 0.15);
    CHECK(kind_of(clipped) == LogFaultKind::clipped);
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
