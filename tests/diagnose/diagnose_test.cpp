// Diagnoses from recordings to verdict, on machines whose truth the tests know and the diagnosis does not.
#include "surefoot/diagnose/diagnose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"
#include "tests/support/walking_robot.hpp"

using namespace surefoot::diagnosis;

using surefoot::Augmented;
using surefoot::diagnose;
using surefoot::DiagnoseOptions;
using surefoot::Diagnosis;
using surefoot::NamedEffect;
using surefoot::Pose2;
using surefoot::Verdict;
using toys::ServoPendulum;
using toys::WalkingRobot;

namespace {

Augmented machine(std::vector<NamedEffect> effects) {
  Augmented result;
  result.parameters = {1.4, 3.9, 0.014};
  result.effects = std::move(effects);
  return result;
}

Diagnosis diagnose_servo(std::vector<NamedEffect> effects, std::uint64_t seed) {
  const auto recordings = toys::servo_recordings(machine(std::move(effects)), 7, seed);
  return diagnose(ServoPendulum{}, recordings, {}, surefoot::Threads{}, seed);
}

const auto nothing = [](Pose2 moved, Pose2 /*at*/) { return moved; };

bool holds(const surefoot::FittedValue& value, double truth) {
  const double slack = 0.5 * (value.high - value.low);  // intervals of 95 % may miss
  return value.low - slack <= truth && truth <= value.high + slack;
}

}  // namespace

TEST_CASE("a wrong parameter is not missing physics") {
  const Diagnosis diagnosis = diagnose_servo({}, 1);
  CHECK(diagnosis.verdict == Verdict::parameters_only);
  CHECK(diagnosis.effects.empty());
  CHECK_FALSE(diagnosis.limits.empty());
  CHECK(diagnosis.parameters[0].fit.value == doctest::Approx(1.4).epsilon(0.01));
  CHECK(diagnosis.held_out_after == diagnosis.held_out_before);
}

TEST_CASE("a model with the right parameters is adequate") {
  auto truth = machine({});
  truth.parameters.clear();
  const auto recordings = toys::servo_recordings(truth, 6, 2);
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, {}, surefoot::Threads{}, 2);
  CHECK(diagnosis.verdict == Verdict::adequate);
}

TEST_CASE("dry friction is found, measured and told from what resembles it") {
  const Diagnosis diagnosis =
      diagnose_servo({{.name = "coulomb_friction", .attached_to = "omega", .values = {0.15}}}, 3);
  CHECK(diagnosis.verdict == Verdict::missing_physics);
  REQUIRE_FALSE(diagnosis.effects.empty());
  const auto& effect = diagnosis.effects.front();
  CHECK(effect.name == "coulomb_friction");
  CHECK(effect.attached_to == "omega");
  CHECK(effect.parameters.front().unit == "N m");
  CHECK(effect.parameters.front().value == doctest::Approx(0.15).epsilon(0.05));
  CHECK(effect.evidence.gain > 0.3);
  CHECK(effect.evidence.p_value < 0.01);
  CHECK(diagnosis.held_out_after < 0.7 * diagnosis.held_out_before);
  CHECK(diagnosis.sentence.find("dry friction") != std::string::npos);
}

TEST_CASE("a delay is told from a lag") {
  const Diagnosis delayed = diagnose_servo({{.name = "input_delay", .attached_to = "goal", .values = {0.02}}}, 4);
  REQUIRE(delayed.effects.size() == 1);
  CHECK(delayed.effects.front().name == "input_delay");
  CHECK(holds(delayed.effects.front().parameters.front(), 0.02));
  const Diagnosis lagging = diagnose_servo({{.name = "first_order_lag", .attached_to = "goal", .values = {0.05}}}, 5);
  REQUIRE(lagging.effects.size() == 1);
  CHECK(lagging.effects.front().name == "first_order_lag");
}

namespace {

// Recordings of 120 rows that begin at rest, of a machine whose input comes 0.12 s late; noise of 1 % of its outputs.
template <class Machine>
std::vector<surefoot::Recording> late_recordings(const Machine& machine, const std::string& input) {
  std::vector<surefoot::Recording> recordings;
  surefoot::Rng rng(3);
  for (int r = 0; r < 6; ++r) {
    surefoot::Recording one = toys::blank_recording(machine.info(), 120, 0.05);
    one.name = "recording " + std::to_string(r);
    one.inputs.rightCols(110) = toys::tank_recording(r, 120).inputs.leftCols(110);
    one.outputs = simulate_augmented(machine, toys::machine({}, {{"input_delay", input, {}, {}, {0.12}}}), one).outputs;
    for (Eigen::Index k = 0; k < one.outputs.rows(); ++k) {
      const double noise = 0.01 * one.outputs.row(k).norm() / std::sqrt(120.0);
      for (Eigen::Index row = 1; row < one.rows(); ++row) one.outputs(k, row) += noise * rng.normal();
    }
    recordings.push_back(std::move(one));
  }
  return recordings;
}

}  // namespace

TEST_CASE("in open loop a late input and a late only sensor are the same, and that is said") {
  DiagnoseOptions options;
  options.effects = {"input_delay", "sensor_delay", "sensor_scale", "constant_rate"};
  const Diagnosis one =
      diagnose(toys::LeakyTank{}, late_recordings(toys::LeakyTank{}, "valve"), options, surefoot::Threads{}, 1);
  REQUIRE(one.effects.size() == 1);
  const bool input = one.effects[0].name == "input_delay";
  CHECK((input || one.effects[0].name == "sensor_delay"));
  CHECK(one.effects[0].parameters[0].value == doctest::Approx(0.12).epsilon(0.1));
  REQUIRE_FALSE(one.alternatives.empty());
  CHECK(one.alternatives[0].indistinguishable);
  CHECK(one.alternatives[0].effects.at(0).first == (input ? "sensor_delay" : "input_delay"));
  CHECK(one.sentence.find(input ? "sensor delay at level_m" : "input delay at valve") != std::string::npos);
}

TEST_CASE("one late input is named where several sensors are late, not one of these") {
  DiagnoseOptions options;
  options.effects = {"input_delay", "sensor_delay", "sensor_scale", "viscous_friction"};
  const Diagnosis two =
      diagnose(toys::SlidingBlock{}, late_recordings(toys::SlidingBlock{}, "push"), options, surefoot::Threads{}, 1);
  REQUIRE(two.effects.size() == 1);
  CHECK(two.effects[0].name == "input_delay");
  CHECK(two.effects[0].parameters[0].value == doctest::Approx(0.12).epsilon(0.1));
}

TEST_CASE("two effects are found together") {
  const Diagnosis diagnosis = diagnose_servo({{.name = "constant_force", .attached_to = "omega", .values = {0.1}},
                                              {.name = "dead_zone", .attached_to = "duty", .values = {0.08}}},
                                             6);
  REQUIRE(diagnosis.effects.size() == 2);
  std::vector<std::string> names{diagnosis.effects[0].name, diagnosis.effects[1].name};
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"constant_force", "dead_zone"});
}

TEST_CASE("an effect that the model has already is calibrated, not found again") {
  const auto recordings =
      toys::servo_recordings(machine({{.name = "coulomb_friction", .attached_to = "omega", .values = {0.15}}}), 7, 7);
  DiagnoseOptions options;
  options.known = {{.name = "coulomb_friction", .attached_to = "omega", .values = {0.1}}};
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, options, surefoot::Threads{}, 7);
  CHECK(diagnosis.effects.empty());
  CHECK(diagnosis.verdict != Verdict::unexplained);
  REQUIRE(diagnosis.known_effects.size() == 1);
  CHECK(diagnosis.known_effects.front().parameters.front().value == doctest::Approx(0.15).epsilon(0.05));
}

TEST_CASE("what no effect describes is called unexplained") {
  auto recordings = toys::servo_recordings(machine({}), 7, 8);
  for (auto& recording : recordings) {  // somebody shakes the table now and then
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      const double t = recording.time[i], phase = 2.1 * std::sin(3.0 * static_cast<double>(recording.name.back()));
      recording.outputs(0, i) +=
          0.02 * std::sin(9.0 * t + phase) * std::exp(-std::pow((std::fmod(t + phase, 1.1) - 0.5) / 0.15, 2));
    }
  }
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, {}, surefoot::Threads{}, 8);
  CHECK(diagnosis.verdict == Verdict::unexplained);
}

TEST_CASE("the same seed gives the same diagnosis for any number of threads") {
  const auto recordings =
      toys::servo_recordings(machine({{.name = "dead_zone", .attached_to = "duty", .values = {0.1}}}), 5, 9);
  const Diagnosis one = diagnose(ServoPendulum{}, recordings, {}, surefoot::Serial{}, 9);
  const Diagnosis other = diagnose(ServoPendulum{}, recordings, {}, surefoot::Threads{3}, 9);
  CHECK(other.sentence == one.sentence);
  CHECK(other.held_out_after == one.held_out_after);
  CHECK(other.held_out_forest == one.held_out_forest);
  REQUIRE(other.effects.size() == one.effects.size());
  CHECK(other.effects.front().parameters.front().value == one.effects.front().parameters.front().value);
  CHECK(other.effects.front().evidence.confidence == one.effects.front().evidence.confidence);
}

TEST_CASE("walking: noise accumulates, and is not taken for physics") {
  for (const bool final_pose_only : {false, true}) {
    const auto recordings = toys::walk_recordings(nothing, final_pose_only, 50, 10);
    const Diagnosis diagnosis = diagnose(WalkingRobot{}, recordings, {}, surefoot::Threads{}, 10);
    CHECK(diagnosis.verdict == Verdict::parameters_only);
    CHECK(diagnosis.noise_sentence.find("accumulates") != std::string::npos);
  }
}

TEST_CASE("walking effects are found from final poses alone") {
  const auto drift = [](Pose2 moved, Pose2 /*at*/) {
    return Pose2{moved.x + 0.003, moved.y - 0.002, moved.angle + 0.01};
  };
  const auto slope = [](Pose2 moved, Pose2 at) {
    const double c = std::cos(at.angle), s = std::sin(at.angle);
    return Pose2{moved.x + c * 0.004 + s * 0.003, moved.y - s * 0.004 + c * 0.003, moved.angle};
  };
  const auto coupling = [](Pose2 moved, Pose2 /*at*/) { return Pose2{moved.x, moved.y, moved.angle + 1.5 * moved.x}; };
  const auto name = [](const auto& change) {
    const auto recordings = toys::walk_recordings(change, true, 60, 11);
    DiagnoseOptions options;
    options.effects = {"body_drift", "ground_slope", "cross_coupling", "input_gain"};
    const Diagnosis diagnosis = diagnose(WalkingRobot{}, recordings, options, surefoot::Threads{}, 11);
    return diagnosis.effects.empty() ? std::string("none") : diagnosis.effects.front().name;
  };
  CHECK(name(drift) == "body_drift");
  CHECK(name(slope) == "ground_slope");
  CHECK(name(coupling) == "cross_coupling");
}

TEST_CASE("an effect of the user's own is found among the others") {
  surefoot::Effect magnet{
      .name = "magnet",
      .sentence = "a magnet of {strength}",
      .place = surefoot::Place::velocity,
      .parameters =
          {{.name = "strength", .measure = {.effort = 1}, .low = -3, .high = 3, .starts = {0.1}, .strength = true}},
      .force = [](const surefoot::EffectContext& m, surefoot::Values p, surefoot::Values) {
        return -p[0] * std::exp(-std::pow((m.position - 0.3) / 0.1, 2));
      }};
  Augmented truth = machine({{.name = "magnet", .attached_to = "omega", .values = {0.4}}});
  auto recordings = toys::servo_recordings(machine({}), 7, 12);
  truth.integration.step = 0.001;
  surefoot::Rng rng(12);
  for (auto& recording : recordings) {
    recording.outputs = surefoot::simulate_augmented(ServoPendulum{}, truth, recording, {magnet}).outputs;
    for (double& value : recording.outputs.reshaped()) value += 0.001 * rng.normal();
  }
  DiagnoseOptions options;
  options.more_effects = {magnet};
  options.effects = {"magnet", "coulomb_friction", "viscous_friction", "constant_force", "cubic_stiffness"};
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, options, surefoot::Threads{}, 12);
  REQUIRE_FALSE(diagnosis.effects.empty());
  CHECK(diagnosis.effects.front().name == "magnet");
  CHECK(diagnosis.effects.front().parameters.front().value == doctest::Approx(0.4).epsilon(0.1));
}

TEST_CASE("one long recording is cut into parts, of which each is held out once") {
  const auto recordings =
      toys::servo_recordings(machine({{.name = "coulomb_friction", .attached_to = "omega", .values = {0.15}}}), 1, 15);
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, {}, surefoot::Threads{}, 15);
  CHECK(diagnosis.fit.size() == 5);
  CHECK(diagnosis.held_out == diagnosis.fit);
  CHECK(diagnosis.verdict == Verdict::missing_physics);
  REQUIRE_FALSE(diagnosis.effects.empty());
  CHECK(diagnosis.effects.front().name == "coulomb_friction");
  CHECK(diagnosis.held_out_after < 0.7 * diagnosis.held_out_before);
}

TEST_CASE("one short recording is refused") {
  auto recordings = toys::servo_recordings(machine({}), 1, 16);
  recordings.front() =
      surefoot::part_of(recordings.front(), 0, 50, recordings.front().initial, recordings.front().initial_scale);
  CHECK_THROWS_WITH_AS(
      diagnose(ServoPendulum{}, recordings, {}, surefoot::Serial{}, 1),
      "one short recording is not enough to tell what is missing: record at least two, or one of 60 rows",
      surefoot::DiagnoseError);
}

TEST_CASE("only effects that the user asks for are looked for") {
  const auto recordings =
      toys::servo_recordings(machine({{.name = "coulomb_friction", .attached_to = "omega", .values = {0.15}}}), 4, 17);
  DiagnoseOptions options;
  options.effects = {"dead_zone", "sensor_bias"};
  options.max_effects = 1;
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, options, surefoot::Threads{}, 17);
  for (const auto& effect : diagnosis.effects) {
    CAPTURE(effect.name);
    CHECK((effect.name == "dead_zone" || effect.name == "sensor_bias"));
  }
  options.effects = {"dead_zone", "coulomb_friction"};
  const Diagnosis right = diagnose(ServoPendulum{}, recordings, options, surefoot::Threads{}, 17);
  REQUIRE(right.effects.size() == 1);
  CHECK(right.effects.front().name == "coulomb_friction");
}

TEST_CASE("effects that make it worse on the held-out recordings are dropped, and it is said") {
  const auto rubbing = machine({{.name = "coulomb_friction", .attached_to = "omega", .values = {0.15}}});
  auto recordings = toys::servo_recordings(rubbing, 7, 18);
  const auto smooth = toys::servo_recordings(machine({}), 7, 18);
  recordings[5] = smooth[5];
  recordings[6] = smooth[6];
  DiagnoseOptions options;
  options.held_out = {"recording 5", "recording 6"};
  options.effects = {"coulomb_friction", "viscous_friction"};
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, options, surefoot::Threads{}, 18);
  CHECK(diagnosis.effects.empty());
  CHECK(diagnosis.held_out_after >= diagnosis.held_out_before);
  CHECK(std::any_of(diagnosis.remarks.begin(), diagnosis.remarks.end(), [](const surefoot::Remark& remark) {
    return remark.text.find("did not lower the error on the held-out recordings") != std::string::npos;
  }));
}

TEST_CASE("a model that yields no numbers is refused") {
  struct Hopeless : ServoPendulum {
    State derivative(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const {
      return State::Constant(std::nan(""));
    }
  };
  CHECK_THROWS_WITH_AS(diagnose(Hopeless{}, toys::servo_recordings(machine({}), 4, 19), {}, surefoot::Serial{}, 1),
                       doctest::Contains("the model cannot be simulated over the recordings with any parameters"),
                       surefoot::DiagnoseError);
}

TEST_CASE("recordings that do not fit the simulator are refused by name") {
  auto recordings = toys::servo_recordings(machine({}), 4, 13);
  recordings[2].time[100] = recordings[2].time[99];
  CHECK_THROWS_WITH_AS(diagnose(ServoPendulum{}, recordings, {}, surefoot::Serial{}, 1),
                       "recording 2: time does not rise at row 100", surefoot::DiagnoseError);
  CHECK_THROWS_AS(diagnose(ServoPendulum{}, std::vector<surefoot::Recording>{}, {}, surefoot::Serial{}, 1),
                  surefoot::DiagnoseError);
  DiagnoseOptions options;
  options.effects = {"ghost"};
  CHECK_THROWS_WITH_AS(
      diagnose(ServoPendulum{}, toys::servo_recordings(machine({}), 4, 13), options, surefoot::Serial{}, 1),
      doctest::Contains("there is no effect called 'ghost'"), surefoot::DiagnoseError);
}

TEST_CASE("a diagnosis that is stopped says so") {
  const auto recordings = toys::servo_recordings(machine({}), 4, 14);
  std::stop_source source;
  source.request_stop();
  const Diagnosis diagnosis = diagnose(ServoPendulum{}, recordings, {}, surefoot::Serial{}, 14, source.get_token());
  CHECK_FALSE(diagnosis.complete);
}
