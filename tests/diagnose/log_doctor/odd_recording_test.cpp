#include "surefoot/diagnose/log_doctor/odd_recording.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnose/log_doctor/servo_log.hpp"
#include "tests/support/walking_robot.hpp"

namespace {

using namespace surefoot::diagnosis;

/// What follows its goal the faster, the harder it is pulled: too fast for steps of a row where it is pulled most.
struct Pull {
  using State = surefoot::Vec<1>;
  using Input = surefoot::Vec<2>;
  using Output = surefoot::Vec<1>;

  surefoot::SimulatorInfo info() const {
    return {.name = "pull",
            .states = {{"level", "m"}},
            .inputs = {{"goal", "m"}, {"pull", "1"}},
            .outputs = {{"level_m", "m"}},
            .parameters = {{"speed", "1/s", 8, 1, 20}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return State(p[0] * u[1] * (u[0] - x[0]));
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

surefoot::Recording pulled(double pull, int number) {
  surefoot::Recording recording;
  recording.name = "rec_" + std::to_string(number);
  recording.time.setLinSpaced(200, 0, 1.99);
  recording.inputs.setConstant(2, 200, pull);
  recording.outputs.setZero(1, 200);
  recording.initial = recording.initial_scale = Eigen::VectorXd::Zero(1);
  surefoot::Rng rng(static_cast<std::uint64_t>(number) + 1);
  double level = 0;
  for (Eigen::Index row = 0; row < 200; ++row) {
    recording.inputs(0, row) = (row / 40) % 2 == 0 ? 1 : -0.5;
    recording.outputs(0, row) = level + 0.01 * rng.normal();
    level += (1 - std::exp(-8 * pull * 0.01)) * (recording.inputs(0, row) - level);
  }
  return recording;
}

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

  TEST_CASE("a recording of which the simulation runs away is not odd for that") {
    const auto bind = [](std::vector<surefoot::Recording> some) { return bind_simulator(Pull{}, std::move(some)); };
    const Parallel parallel = serially();
    const LogDoctorInputs inputs{bind, [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
    std::vector<surefoot::Recording> log;
    for (int r = 0; r < 6; ++r) log.push_back(pulled(r == 3 ? 40 : 1, r));
    const LogFit fit = fit_log(inputs, log);
    INFO(fit.error[3]);
    CHECK(fit.error[3] > 1);
    CHECK_FALSE(find_odd_recording(inputs, fit));
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

  TEST_CASE("the readings of another walk are odd though noise adds up in all") {
    const auto bind = [](std::vector<surefoot::Recording> some) {
      return bind_simulator(toys::WalkingRobot{}, std::move(some));
    };
    const Parallel parallel = serially();
    const LogDoctorInputs inputs{bind, [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
    const auto as_ordered = [](const surefoot::Pose2& moved, const surefoot::Pose2&) { return moved; };
    auto log = toys::walk_recordings(as_ordered, false, 8, 1);
    CHECK_FALSE(find_odd_recording(inputs, fit_log(inputs, log)));
    log[3].outputs = toys::walk_recordings(as_ordered, false, 4, 2)[3].outputs;
    const auto odd = find_odd_recording(inputs, fit_log(inputs, log));
    REQUIRE(odd);
    CHECK(odd->recording == 3);
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
