#include "surefoot/diagnose/log_doctor/describe_fault.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

TEST_SUITE("log_doctor") {
  TEST_CASE("a fault is one sentence that names recording, column and size") {
    const BoundSimulator bound = bind_simulator(toys::Servo{}, toys::servo_log({}, 3));
    const FoundFault stuck{{{.kind = LogFaultKind::stuck, .channel = {false, 1}, .rows = {{10, 20}}}}, 1};
    const auto faults = describe_fault(bound, stuck);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].kind == "stuck_sensor");
    CHECK(faults[0].channel == "omega_rad_s");
    CHECK(faults[0].sentence.starts_with("rec_02.csv: omega_rad_s is stuck at "));
    CHECK(faults[0].sentence.ends_with(" from 0.1 to 0.19 s, while the model moves on"));
  }

  TEST_CASE("what cannot be told apart is said") {
    const BoundSimulator bound = bind_simulator(toys::Servo{}, toys::servo_log({}, 3));
    const Repairs output{{.kind = LogFaultKind::sign, .amount = -1}};
    const Repairs input{{.kind = LogFaultKind::sign, .channel = {true, 0}, .amount = -1}};
    const auto faults = describe_fault(bound, FoundFault{output, 0, {input}});
    CHECK(faults[0].sentence ==
          "rec_01.csv: theta_rad has the opposite sign of that in the other recordings (or goal has the opposite sign "
          "of that in the other recordings, which these recordings cannot tell from it)");
  }

  TEST_CASE("clocks of most recordings are one fault, of few one each") {
    const BoundSimulator bound = bind_simulator(toys::Servo{}, toys::servo_log({}, 3));
    const auto one = describe_fault(bound, ClockFault{LogFaultKind::time_skew, {0, 0.02, 0}});
    REQUIRE(one.size() == 1);
    CHECK(one[0].sentence == "rec_02.csv: its clock is 2 % fast against those of other recordings");
    const auto all = describe_fault(bound, ClockFault{LogFaultKind::offset, {-0.03, 0, 0.04}});
    REQUIRE(all.size() == 1);
    CHECK(all[0].recording.empty());
    CHECK(all[0].size == doctest::Approx(0.07));
  }
}

}  // namespace
