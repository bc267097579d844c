#include "surefoot/diagnose/log_doctor/examine_log.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using surefoot::LogFault;
using surefoot::Recording;
using Log = std::vector<Recording>;

/// Exactly one fault, of that kind and recording, in the log and none after the repair.
LogFault only_fault(const Log& log, const std::string& kind, const std::string& recording) {
  const auto examined = toys::examined(log);
  std::string all;
  for (const LogFault& fault : examined.faults) all += fault.sentence + "\n";
  INFO(all);
  REQUIRE(examined.faults.size() == 1);
  CHECK(examined.faults[0].kind == kind);
  CHECK(examined.faults[0].recording == recording);
  CHECK_FALSE(examined.faults[0].cure.empty());
  CHECK(toys::examined(examined.repaired).faults.empty());
  return examined.faults[0];
}

/// A tank that drains by the root of its level: over steps of minutes it only follows its inflow.
struct DrainedTank {
  using State = surefoot::Vec<1>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<1>;

  surefoot::SimulatorInfo info() const {
    return {.name = "tank",
            .states = {{"level", "m"}},
            .inputs = {{"pump", "V"}},
            .outputs = {{"level_m", "m"}},
            .parameters = {{"gain", "m/(s V)", 0.0016, 0.0002, 0.01}, {"drain", "m^0.5/s", 0.013, 0.001, 0.1}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return State(p[0] * u[0] - p[1] * std::sqrt(std::max(x[0], 0.0)));
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

/// Recording number r of 400 rows, one a second, with an inflow in steps.
Recording drained(int r) {
  Recording recording;
  recording.name = "rec_0" + std::to_string(r + 1) + ".csv";
  recording.time.setLinSpaced(400, 0, 399);
  recording.inputs.setZero(1, 400);
  recording.outputs.setZero(1, 400);
  recording.initial = Eigen::VectorXd::Constant(1, 0.2 + 0.03 * r);
  recording.initial_scale = Eigen::VectorXd::Zero(1);
  surefoot::Rng rng(11, static_cast<std::uint64_t>(r));
  for (Eigen::Index row = 0; row < 400; ++row) {
    recording.inputs(0, row) = row % 60 == 0 ? 1 + 4 * rng.uniform() : recording.inputs(0, row - 1);
  }
  surefoot::Augmented machine;
  machine.parameters = {0.0019, 0.0105};
  recording.outputs = simulate_augmented(DrainedTank{}, machine, recording).outputs;
  for (double& level : recording.outputs.reshaped()) level += 0.002 * rng.normal();
  return recording;
}

constexpr double degrees = 180 / std::numbers::pi;
TEST_SUITE("log_doctor") {
  TEST_CASE("clean logs have no fault, whatever physics the model leaves out") {
    using Effects = std::vector<surefoot::NamedEffect>;
    for (const Effects& effects : {Effects{}, toys::dry_friction(),
                                   Effects{{"input_delay", "goal", {}, {}, {0.05}}},
                                   Effects{{"sensor_delay", "theta_rad", {}, {}, {0.04}}},
                                   Effects{{"saturation", "goal", {}, {}, {0.6}}},
                                   Effects{{"quantization", "theta_rad", {}, {}, {0.05}}}}) {
      const auto examined = toys::examined(toys::servo_log(effects));
      INFO((effects.empty() ? "none" : effects[0].name));
      INFO((examined.faults.empty() ? "" : examined.faults[0].sentence));
      CHECK(examined.faults.empty());
    }
  }

  TEST_CASE("an output of the opposite sign is named with its recording") {
    Log log = toys::servo_log(toys::dry_friction());
    log[2].outputs.row(0) *= -1;
    const LogFault fault = only_fault(log, "sign_flipped", "rec_03.csv");
    CHECK(fault.channel == "theta_rad");
    CHECK(fault.sentence == "rec_03.csv: theta_rad has the opposite sign of that in the other recordings");
  }

  TEST_CASE("degrees for radians are named, in one recording and in all") {
    Log log = toys::servo_log(toys::dry_friction());
    log[4].outputs.row(0) *= degrees;
    CHECK(only_fault(log, "angle_unit", "rec_05.csv").channel == "theta_rad");
    log = toys::servo_log(toys::dry_friction());
    for (Recording& recording : log) recording.inputs *= degrees;
    CHECK(only_fault(log, "angle_unit", "").channel == "goal");
  }

  TEST_CASE("milliseconds for seconds are named, in one recording and in all") {
    Log log = toys::servo_log(toys::dry_friction());
    log[1].time *= 1000;
    only_fault(log, "time_unit", "rec_02.csv");
    log = toys::servo_log(toys::dry_friction());
    for (Recording& recording : log) recording.time *= 1000;
    only_fault(log, "time_unit", "");
  }

  TEST_CASE("swapped columns are named, in one recording and in all") {
    Log log = toys::servo_log(toys::dry_friction());
    log[0].outputs.row(0).swap(log[0].outputs.row(1));
    only_fault(log, "columns_swapped", "rec_01.csv");
    log = toys::servo_log(toys::dry_friction());
    for (Recording& recording : log) recording.outputs.row(0).swap(recording.outputs.row(1));
    only_fault(log, "columns_swapped", "");
    log = toys::servo_log(toys::dry_friction());
    log[3].inputs.row(0).swap(log[3].outputs.row(0));  // the goal, and what was reached
    only_fault(log, "columns_swapped", "rec_04.csv");
  }

  TEST_CASE("clocks that are off by another time in each recording are named, a delay of all is not") {
    Log log = toys::servo_log(toys::dry_friction());
    const double late[] = {0.0, 0.08, 0.03, 0.1, 0.01, 0.06};
    for (std::size_t r = 0; r < log.size(); ++r) toys::delay_outputs(log[r], late[r]);
    const auto examined = toys::examined(log);
    REQUIRE(examined.faults.size() == 1);
    CHECK(examined.faults[0].kind == "clock_offset");
    CHECK(examined.faults[0].size == doctest::Approx(0.1).epsilon(0.1));
  }

  TEST_CASE("outputs that are early in most recordings are the clock's as far as that goes, for no machine is early") {
    Log log = toys::servo_log(toys::dry_friction());
    const double early[] = {0.06, 0.0, 0.09, 0.03, 0.1, 0.07};
    for (std::size_t r = 0; r < log.size(); ++r) toys::advance_outputs(log[r], early[r]);
    const auto examined = toys::examined(log);
    REQUIRE(examined.faults.size() == 1);
    CHECK(examined.faults[0].kind == "clock_offset");
    const Log on_time = toys::servo_log(toys::dry_friction());
    for (std::size_t r = 0; r < log.size(); ++r) {
      CHECK(examined.repaired[r].outputs(0, 120) == doctest::Approx(on_time[r].outputs(0, 120)).epsilon(0.05));
    }
  }

  TEST_CASE("clocks that differ beside much physics that is missing are suspected, a delay of all is not") {
    const std::vector<surefoot::NamedEffect> much{{"coulomb_friction", "omega", {}, {}, {10.0}}};
    const Log clean = toys::servo_log(much);
    Log log = clean;
    const double late[] = {0.0, 0.05, 0.02, 0.06, 0.01, 0.04};
    for (std::size_t r = 0; r < log.size(); ++r) toys::delay_outputs(log[r], late[r]);
    const auto examined = toys::examined(log);
    CHECK(examined.faults.empty());
    REQUIRE(examined.suspected.size() == 1);
    CHECK(examined.suspected[0].kind == "clock_offset");
    CHECK(examined.suspected[0].size == doctest::Approx(0.06).epsilon(0.3));
    REQUIRE(examined.without_suspected.size() == log.size());
    CHECK(examined.without_suspected[3].outputs != examined.repaired[3].outputs);
    CHECK(toys::examined(clean).suspected.empty());
    log = clean;
    for (Recording& recording : log) toys::delay_outputs(recording, 0.05);
    CHECK(toys::examined(log).suspected.empty());
  }

  TEST_CASE("one late clock is named with its recording") {
    Log log = toys::servo_log();
    toys::delay_outputs(log[3], 0.05);
    const LogFault fault = only_fault(log, "clock_offset", "rec_04.csv");
    CHECK(fault.size == doctest::Approx(0.05).epsilon(0.1));
  }

  TEST_CASE("a fast clock is named with its recording") {
    Log log = toys::servo_log();
    log[2].time *= 1.02;
    CHECK(only_fault(log, "clock_skew", "rec_03.csv").size == doctest::Approx(0.02).epsilon(0.15));
  }

  TEST_CASE("clocks that run fast in one recording and slow in another are no clocks") {
    Log log = toys::servo_log({}, 12);
    log[2].time *= 1.01;
    log[3].time *= 0.97;
    CHECK(toys::examined(log).faults.empty());
  }

  TEST_CASE("a stuck sensor is named with its recording") {
    Log log = toys::servo_log(toys::dry_friction());
    for (Eigen::Index row = 90; row < 150; ++row) log[5].outputs(0, row) = log[5].outputs(0, 89);
    CHECK(only_fault(log, "stuck_sensor", "rec_06.csv").channel == "theta_rad");
  }

  TEST_CASE("clipped readings are named with their recording") {
    Log log = toys::servo_log(toys::dry_friction());
    const double end = 0.6 * log[1].outputs.row(0).maxCoeff();
    for (double& value : log[1].outputs.row(0)) value = std::min(value, end);
    CHECK(only_fault(log, "clipped", "rec_02.csv").channel == "theta_rad");
  }

  TEST_CASE("missing rows and repeated rows are named with their recording") {
    Log log = toys::servo_log(toys::dry_friction());
    Recording& short_one = log[0];
    const Eigen::Index from = 200, length = 40, rest = 300 - from - length;
    short_one.time.segment(from, rest) = short_one.time.tail(rest).eval();
    short_one.inputs.middleCols(from, rest) = short_one.inputs.rightCols(rest).eval();
    short_one.outputs.middleCols(from, rest) = short_one.outputs.rightCols(rest).eval();
    short_one.time.conservativeResize(from + rest);
    short_one.inputs.conservativeResize(1, from + rest);
    short_one.outputs.conservativeResize(2, from + rest);
    only_fault(log, "dropped_samples", "rec_01.csv");
    log = toys::servo_log(toys::dry_friction());
    for (Eigen::Index row = 3; row < 300; row += 4) log[4].outputs(0, row) = log[4].outputs(0, row - 1);
    only_fault(log, "dropped_samples", "rec_05.csv");
  }

  TEST_CASE("a recording of another experiment is named, and left out if that may be") {
    Log log = toys::servo_log(toys::dry_friction());
    const Log other = toys::servo_log({}, 7);
    log[3].outputs = -0.6 * other[6].outputs.rowwise().reverse();
    log[3].outputs.col(0).setZero();
    const auto examined = toys::examined(log);
    REQUIRE(examined.faults.size() == 1);
    CHECK(examined.faults[0].kind == "odd_recording");
    CHECK(examined.faults[0].recording == "rec_04.csv");
    CHECK(examined.faults[0].repaired);
    CHECK(examined.repaired.size() + 1 == log.size());
    for (const Recording& recording : examined.repaired) CHECK(recording.name != "rec_04.csv");

    const surefoot::diagnosis::Parallel parallel = surefoot::diagnosis::serially();
    surefoot::diagnosis::LogDoctorInputs inputs = toys::servo_doctor(parallel);
    inputs.may_leave_out = false;
    const auto kept = surefoot::diagnosis::examine_log(inputs, log);
    REQUIRE(kept.faults.size() == 1);
    CHECK_FALSE(kept.faults[0].repaired);
    CHECK(kept.repaired.size() == log.size());
  }

  TEST_CASE("that a recording of another experiment jumps says nothing, for the model does not hold for it") {
    Log log = toys::servo_log(toys::dry_friction());
    const Log other = toys::servo_log({}, 7);
    log[2].outputs = -0.6 * other[6].outputs.rowwise().reverse();
    log[2].outputs.col(0).setZero();
    for (Eigen::Index row = 140; row < 300; ++row) log[2].outputs.col(row) -= Eigen::Vector2d(1.8, 18);
    for (const bool may_leave_out : {true, false}) {
      const surefoot::diagnosis::Parallel parallel = surefoot::diagnosis::serially();
      surefoot::diagnosis::LogDoctorInputs inputs = toys::servo_doctor(parallel);
      inputs.may_leave_out = may_leave_out;
      const auto examined = surefoot::diagnosis::examine_log(inputs, log);
      REQUIRE(examined.faults.size() == 1);
      CHECK(examined.faults[0].kind == "odd_recording");
      CHECK(examined.faults[0].recording == "rec_03.csv");
      if (!may_leave_out) CHECK(examined.repaired[2].rows() == 300);  // as it was logged
    }
  }

  TEST_CASE("a unit of time that leads the calibration astray is named beside one without that recording") {
    Log log;
    for (int r = 0; r < 6; ++r) log.push_back(drained(r));
    log[4].time *= 1000;
    const auto bind = [](Log some) { return surefoot::diagnosis::bind_simulator(DrainedTank{}, std::move(some)); };
    const surefoot::diagnosis::Parallel parallel = surefoot::diagnosis::serially();
    const auto examined = surefoot::diagnosis::examine_log(
        {bind, [](const auto& bound) { return surefoot::diagnosis::nominal_hypothesis(bound); }, parallel}, log);
    REQUIRE(examined.faults.size() == 1);
    CHECK(examined.faults[0].kind == "time_unit");
    CHECK(examined.faults[0].recording == "rec_05.csv");
    CHECK(examined.repaired[4].time[399] == doctest::Approx(399));
  }

  TEST_CASE("two rows, one recording and sparse outputs are no faults") {
    Log log = toys::servo_log();
    for (Eigen::Index row = 0; row < 300; ++row) {
      if (row % 10 != 0) log[2].outputs.col(row).setConstant(std::nan(""));
    }
    CHECK(toys::examined(log).faults.empty());
    CHECK(toys::examined({log[0]}).faults.empty());
    for (Recording& recording : log) {
      recording.time.conservativeResize(2);
      recording.inputs.conservativeResize(1, 2);
      recording.outputs.conservativeResize(2, 2);
    }
    CHECK(toys::examined(log).faults.empty());
  }

  TEST_CASE("an examination ends when its time is over, and says nothing that it did not compare to the end") {
    Log log = toys::servo_log();
    log[2].outputs.row(0) *= -1;
    const surefoot::diagnosis::Parallel parallel = surefoot::diagnosis::serially();
    surefoot::diagnosis::LogDoctorInputs inputs = toys::servo_doctor(parallel);
    inputs.stopped = [] { return true; };
    CHECK(surefoot::diagnosis::examine_log(inputs, log).faults.empty());
    int asked = 0;
    inputs.stopped = [&asked] { return ++asked > 10; };
    const auto cut_short = surefoot::diagnosis::examine_log(inputs, log);
    CHECK(asked > 10);
    for (const LogFault& fault : cut_short.faults) CHECK(fault.kind == "sign_flipped");
  }

  TEST_CASE("what stands before a verdict names the first fault that was not repaired, or was if all were") {
    using surefoot::diagnosis::fault_preface;
    CHECK(fault_preface({}).empty());
    LogFault fault{.kind = "clipped", .sentence = "a: is clipped", .cure = "mend it", .repaired = true};
    CHECK(fault_preface({fault}) == "Without a fault of the log (a: is clipped): ");
    CHECK(fault_preface({fault, fault}) == "Without a fault of the log (a: is clipped, and others): ");
    fault.repaired = false;
    CHECK(fault_preface({fault}) == "Caution, the log has a fault: a: is clipped; mend it. ");
  }
}

}  // namespace
