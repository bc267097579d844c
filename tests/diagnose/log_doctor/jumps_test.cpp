#include "surefoot/diagnose/log_doctor/jumps.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

/// The recording without these rows, as many others follow, at times as if nothing were missing.
void lose_rows(surefoot::Recording& recording, Eigen::Index from, Eigen::Index lost) {
  const Eigen::Index rows = recording.rows() - lost, after = rows - from;
  recording.inputs.middleCols(from, after) = recording.inputs.rightCols(after).eval();
  recording.outputs.middleCols(from, after) = recording.outputs.rightCols(after).eval();
  recording.time.conservativeResize(rows);
  recording.inputs.conservativeResize(Eigen::NoChange, rows);
  recording.outputs.conservativeResize(Eigen::NoChange, rows);
}

std::vector<FoundFault> jumps_of(const LogDoctorInputs& inputs, const std::vector<surefoot::Recording>& log) {
  std::vector<FoundFault> found;
  add_jumps(fit_log(inputs, log), inputs.criteria, found);
  return found;
}

TEST_SUITE("log_doctor") {
  TEST_CASE("rows that were lost while the time was counted on are a jump of all readings, an end stop is none") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    CHECK(jumps_of(inputs, log).empty());
    lose_rows(log[2], 117, 30);
    const auto found = jumps_of(inputs, log);
    REQUIRE(found.size() == 1);
    CHECK(*found[0].recording == 2);
    CHECK(found[0].repairs[0].rows[0] == RowRange{116, 117});
    const auto examined = toys::examined(log);
    REQUIRE(examined.faults.size() == 1);
    CHECK(examined.faults[0].kind == "dropped_samples");
    CHECK(examined.repaired[2].rows() == 153);

    log = toys::servo_log(toys::dry_friction());
    for (Eigen::Index row = 112; row < 140; ++row) {  // stuck
      for (Eigen::Index k = 0; k < 2; ++k) log[2].outputs(k, row) = log[2].outputs(k, 111);
    }
    CHECK(jumps_of(inputs, log).empty());

    log = toys::servo_log();
    surefoot::Augmented stopped;
    stopped.parameters = {90, 8};
    stopped.effects = {{.name = "end_stop", .attached_to = "omega", .form = "upper", .values = {0.2, 0.0}}};
    log[2].outputs = simulate_augmented(toys::Servo{}, stopped, log[2]).outputs;
    CHECK(jumps_of(inputs, log).empty());
  }
}

}  // namespace
