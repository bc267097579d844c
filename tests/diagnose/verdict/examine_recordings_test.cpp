// Faults of the log in the course of a diagnosis.
#include "surefoot/diagnose/verdict/examine_recordings.hpp"

#include <doctest/doctest.h>

#include <chrono>

#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/log_doctor/log_repair.hpp"
#include "surefoot/diagnose/verdict/pipeline.hpp"
#include "tests/diagnose/log_doctor/servo_log.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("faults of the log are named first, and repaired only if that is asked for") {
  DiagnoseOptions options;
  const Parallel parallel = serially();
  const RunContext run{options, parallel};
  auto recordings = toys::noisy_tanks({}, 0.01);
  recordings[3].outputs *= -1;
  const auto logged = recordings[3].outputs;
  const auto named = examine_recordings(toys::bind_tank, recordings, run).faults;
  REQUIRE(named.size() == 1);
  CHECK(named[0].recording == "tank 3");
  CHECK(named[0].kind == "sign_flipped");
  CHECK_FALSE(named[0].repaired);
  CHECK(recordings[3].outputs == logged);
  options.repair = true;
  const LogExamination examined = examine_recordings(toys::bind_tank, recordings, run);
  CHECK(examined.faults.at(0).repaired);
  CHECK(examined.repaired[3].outputs(0, 7) == -logged(0, 7));
  recordings = examined.repaired;
  const SimulatorInfo info = toys::LeakyTank{}.info();
  CHECK(run_pipeline(toys::bind_tank, info, recordings, {.max_effects = 0}, parallel, 1, {}).log_faults.empty());
  recordings[3].outputs *= -1;
  CHECK(run_pipeline(toys::bind_tank, info, recordings, {.max_effects = 0}, parallel, 1, {})
            .sentence.starts_with("Caution, the log has a fault: tank 3: level_m has the opposite sign"));
}

TEST_CASE("a fast clock that missing friction hides is named, and repaired if asked for, once the friction is found") {
  const BindSimulator bind = [](std::vector<Recording> some) { return bind_simulator(toys::Servo{}, std::move(some)); };
  const SimulatorInfo info = toys::Servo{}.info();
  auto log = toys::servo_log(toys::dry_friction());
  log[2].time *= 1.02;
  DiagnoseOptions options{.effects = {"coulomb_friction"}, .max_effects = 1};
  const Parallel parallel = serially();
  CHECK(examine_recordings(bind, log, RunContext{options, parallel}).faults.empty());
  const Diagnosis named = run_pipeline(bind, info, log, options, parallel, 1, {});
  REQUIRE(named.log_faults.size() == 1);
  CHECK(named.log_faults[0].kind == "clock_skew");
  CHECK(named.log_faults[0].recording == "rec_03.csv");
  CHECK(named.log_faults[0].size == doctest::Approx(0.02).epsilon(0.05));
  CHECK_FALSE(named.log_faults[0].repaired);
  CHECK(named.sentence.starts_with("Caution, the log has a fault: rec_03.csv"));
  options.repair = true;
  const Diagnosis repaired = run_pipeline(bind, info, log, options, parallel, 1, {});
  REQUIRE(repaired.log_faults.size() == 1);
  CHECK(repaired.log_faults[0].repaired);
  CHECK(named.verdict == Verdict::unexplained);
  CHECK(repaired.verdict == Verdict::missing_physics);
  CHECK(repaired.fit.size() == named.fit.size());
}

TEST_CASE("clocks that differ beside much friction are named once the friction is found without them") {
  const BindSimulator bind = [](std::vector<Recording> some) { return bind_simulator(toys::Servo{}, std::move(some)); };
  const SimulatorInfo info = toys::Servo{}.info();
  auto log = toys::servo_log({{"coulomb_friction", "omega", {}, {}, {10.0}}});
  const double late[] = {0.0, 0.05, 0.02, 0.06, 0.01, 0.04};
  for (std::size_t r = 0; r < log.size(); ++r) toys::delay_outputs(log[r], late[r]);
  DiagnoseOptions options{.effects = {"coulomb_friction", "input_delay"}, .max_effects = 2};
  const Parallel parallel = serially();
  const Diagnosis named = run_pipeline(bind, info, log, options, parallel, 1, {});
  REQUIRE(named.log_faults.size() == 1);
  CHECK(named.log_faults[0].kind == "clock_offset");
  CHECK(named.log_faults[0].size == doctest::Approx(0.06).epsilon(0.2));
  CHECK_FALSE(named.log_faults[0].repaired);
  options.repair = true;
  const Diagnosis repaired = run_pipeline(bind, info, log, options, parallel, 1, {});
  REQUIRE(repaired.log_faults.size() == 1);
  CHECK(repaired.log_faults[0].repaired);
  CHECK(repaired.held_out_after < 0.5 * named.held_out_after);
  REQUIRE(repaired.effects.size() == 2);  // what is late in all is not repaired
}

TEST_CASE("a search begins anew only if there is time for as much again") {
  const Parallel parallel = serially();
  const DiagnoseOptions options{.max_seconds = 1000};
  RunContext run{options, parallel};
  run.began -= std::chrono::seconds(600);
  CHECK(run.has_time_for_as_much_again(300));
  CHECK_FALSE(run.has_time_for_as_much_again(100));
  const DiagnoseOptions patient;
  CHECK(RunContext{patient, parallel, 1, {}, run.began}.has_time_for_as_much_again(0));
}

TEST_CASE("a repaired fault is named again only by the same kind in the same channel of the same recording") {
  const LogFault slow{.kind = "clock_skew", .recording = "rec_03.csv", .size = -0.0137};
  const LogFault fast{.kind = "clock_skew", .recording = "rec_03.csv", .size = 0.0138};
  const LogFault other{.kind = "clock_skew", .recording = "rec_04.csv", .size = 0.0138};
  const LogFault stuck{.kind = "stuck_sensor", .recording = "rec_03.csv", .channel = "theta_rad"};
  CHECK(is_named_again({stuck, slow}, {fast}));
  CHECK_FALSE(is_named_again({slow}, {other, stuck}));
  CHECK_FALSE(is_named_again({slow}, {}));
}

TEST_CASE("that a recording is unlike the others is withdrawn where nothing confirms it, and nothing else is") {
  LogExamination log{{{.kind = name_of(LogFaultKind::odd), .recording = "a"},
                      {.kind = name_of(LogFaultKind::sign), .recording = "b", .channel = "level_m"}},
                     {}};
  withdraw_odd_recording(log);
  REQUIRE(log.faults.size() == 1);
  CHECK(log.faults[0].recording == "b");
  log.faults = {{.kind = name_of(LogFaultKind::odd), .recording = "a", .repaired = true}};
  withdraw_odd_recording(log);
  CHECK(log.faults.size() == 1);  // it was left out
}

TEST_CASE("a fault that the model with what was found does not name again is withdrawn") {
  const LogFault flipped{.kind = "sign_flipped", .recording = "a", .channel = "level_m"},
      stuck{.kind = "stuck_sensor", .recording = "b", .channel = "level_m"};
  LogExamination log{{flipped, stuck}, {}}, again{{stuck}, {}};
  CHECK_FALSE(withdraw_faults(log, again, false));
  REQUIRE(log.faults.size() == 1);
  CHECK(log.faults[0].kind == "stuck_sensor");

  log = {{flipped, stuck}, {}};
  log.faults[0].repaired = true;
  CHECK_FALSE(withdraw_faults(log, again, false));
  CHECK(log.faults.size() == 2);  // what was found is of the repaired log
  CHECK(withdraw_faults(log, again, true));
  CHECK(log.faults.size() == 1);
}

}  // namespace
}  // namespace surefoot::diagnosis
