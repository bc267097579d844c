#include "surefoot/diagnose/log_doctor/clock_faults.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnose/log_doctor/servo_log.hpp"

namespace {

using namespace surefoot::diagnosis;

std::vector<ClockEstimate> estimates(const std::vector<double>& values, double variance) {
  std::vector<ClockEstimate> list;
  for (const double value : values) list.push_back({true, value, variance, 1});
  return list;
}

TEST_SUITE("log_doctor") {
  TEST_CASE("clocks scatter by chance as far as their standard errors say") {
    CHECK(scatter_by_chance(estimates({1, -1, 0.5, -0.5}, 1), {}) > 0.1);
    CHECK(scatter_by_chance(estimates({10, -10, 5, -5}, 1), {}) < 1e-6);
  }

  TEST_CASE("one clock is off if the others agree") {
    CHECK(outlier_by_chance(estimates({0, 0.1, -0.1, 0.05, -0.05, 5}, 0.01), 5, {}) < 1e-5);
    CHECK(outlier_by_chance(estimates({0, 4, -3, 2, -5, 5}, 0.01), 5, {}) > 0.05);
    // others that agree better than they are known do not make it any surer
    CHECK(outlier_by_chance(estimates({0, 0, 0, 0, 0, 3}, 1), 5, {}) > 0.01);
  }

  TEST_CASE("a recording that the model misses says little about clocks") {
    auto clocks = estimates({0.001, 0, -0.001, 0.001, -0.001, 0, 0.017, 0.025}, 1e-6);
    CHECK(outlier_by_chance(clocks, 7, {}) > 1e-3);  // another clock is as far off
    clocks[6].error = 200;
    CHECK(outlier_by_chance(clocks, 7, {}) < 1e-5);
  }

  TEST_CASE("a clock that leaves its recording far worse than all others is not what is wrong with it") {
    auto clocks = estimates({0, 0.1, -0.1, 5}, 0.01);
    CHECK(is_like_others(clocks, 3, {}));
    clocks[3].error = 5;
    CHECK_FALSE(is_like_others(clocks, 3, {}));
    clocks[0].error = 2;
    CHECK(is_like_others(clocks, 3, {}));
  }

  /// A ball that rolls on: nothing brings it back to where it should be.
  struct Ball {
    using State = surefoot::Vec<2>;
    using Input = surefoot::Vec<1>;
    using Output = surefoot::Vec<1>;
    surefoot::SimulatorInfo info() const {
      return {.name = "ball",
              .states = {{"p", "m"}, {"v", "m/s"}},
              .inputs = {{"tilt", "rad"}},
              .outputs = {{"ball_m", "m"}},
              .parameters = {{"roll", "m/s^2", 6, 3, 10}}};
    }
    State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
      return {x[1], p[0] * std::sin(u[0])};
    }
    Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
  };

  TEST_CASE("a clock is fast only if a start within the noise of its first reading does not explain as much") {
    std::vector<surefoot::Recording> log;
    surefoot::Rng rng(2);
    for (int r = 0; r < 4; ++r) {
      surefoot::Recording one;
      one.name = "roll " + std::to_string(r);
      one.time.setLinSpaced(300, 0, 2.99);
      one.inputs = 0.05 * ((2.0 + r) * one.time.transpose()).array().cos().matrix();
      one.outputs.setZero(1, 300);
      one.initial = one.initial_scale = Eigen::Vector2d::Zero();
      one.outputs = simulate_augmented(Ball{}, {.parameters = {6}}, one).outputs;
      for (double& reading : one.outputs.reshaped()) reading += 0.001 * rng.normal();
      one.outputs(0, 0) = one.initial[0] = r == 1 ? 0.003 : 0.0005;  // three times the noise off
      log.push_back(std::move(one));
    }
    const Parallel parallel = serially();
    const LogDoctorInputs inputs{[](std::vector<surefoot::Recording> some) { return bind_simulator(Ball{}, some); },
                                 [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
    const LogFit fit = fit_log(inputs, log);
    CHECK(fit.error[1] > 3 * fit.error[0]);
    for (const double rate : {-0.02, -0.01, 0.01, 0.02}) {
      const auto cured = repaired(fit.bound, log[1], {.kind = LogFaultKind::time_skew, .amount = rate});
      CHECK_FALSE(beats_other_start(inputs, fit, 1, cured));
    }
    log[2].time *= 1.05;
    const LogFit fast = fit_log(inputs, log);
    const auto cured = repaired(fast.bound, log[2], {.kind = LogFaultKind::time_skew, .amount = 0.05});
    CHECK(beats_other_start(inputs, fast, 2, cured));
  }

  TEST_CASE("a clock that explains a recording is not a fault of its columns, which would make it too small to miss") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    const FoundFault in_degrees{{{.kind = LogFaultKind::degrees, .amount = 0.0175}}, 2};
    CHECK_FALSE(clock_explains_more(inputs, fit_log(inputs, log), in_degrees));  // its clock is right
    log[2].time *= 1.02;
    const LogFit fit = fit_log(inputs, log);
    CHECK(clock_explains_more(inputs, fit, in_degrees));
    CHECK_FALSE(clock_explains_more(inputs, fit, {in_degrees.repairs, 3}));  // that of another recording
  }

  TEST_CASE("offsets that differ between all recordings are no fault of one") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    const double late[] = {0.0, 0.08, 0.03, 0.1, 0.01, 0.06};
    for (std::size_t r = 0; r < log.size(); ++r) toys::delay_outputs(log[r], late[r]);
    const LogFit fit = fit_log(inputs, log);
    CHECK(find_clock_fault(inputs, fit));
    CHECK_FALSE(find_clock_fault(inputs, fit, true));
  }

  TEST_CASE("clocks of a map or of too few recordings are not compared") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    CHECK(has_clocks(fit_log(inputs, toys::servo_log({}, 3)), inputs.criteria));
    CHECK_FALSE(has_clocks(fit_log(inputs, toys::servo_log({}, 2)), inputs.criteria));
  }

  TEST_CASE("a clock that is not a row off at the end of its recording is no fault") {
    const surefoot::Recording one = toys::servo_log({}, 1).front();  // 300 rows
    CHECK(stays_within_a_row(one, 0.003));
    CHECK(stays_within_a_row(one, -0.003));
    CHECK_FALSE(stays_within_a_row(one, 0.004));
  }

  TEST_CASE("a delay that all recordings share is physics") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log();
    for (auto& recording : log) toys::delay_outputs(recording, 0.06);
    CHECK_FALSE(find_clock_fault(inputs, fit_log(inputs, log)));
    toys::delay_outputs(log[0], 0.06);
    const auto found = find_clock_fault(inputs, fit_log(inputs, log));
    REQUIRE(found);
    CHECK(found->kind == LogFaultKind::offset);
    CHECK(found->amounts[0] == doctest::Approx(0.06).epsilon(0.1));
  }
}

}  // namespace
