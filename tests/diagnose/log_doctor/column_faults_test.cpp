#include "surefoot/diagnose/log_doctor/column_faults.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnose/log_doctor/servo_log.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace {

using namespace surefoot::diagnosis;
using surefoot::Recording;

/// Two carts, each driven by a command of its own, that reach from half to twice the speed that the model says.
struct TwoCarts {
  using State = surefoot::Vec<2>;
  using Input = surefoot::Vec<2>;
  using Output = surefoot::Vec<2>;

  surefoot::SimulatorInfo info() const {
    return {.name = "carts",
            .states = {{"a", "m"}, {"b", "m"}},
            .inputs = {{"speed_a", "m/s"}, {"speed_b", "m/s"}},
            .outputs = {{"a_m", "m"}, {"b_m", "m"}},
            .parameters = {{"gain_a", "1", 1, 0.5, 2}, {"gain_b", "1", 1, 0.5, 2}}};
  }
  State derivative(const State& /*x*/, const Input& u, const Eigen::VectorXd& p) const {
    return {p[0] * u[0], p[1] * u[1]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

/// Two tanks, of which the upper one drains into the lower one.
struct TwoTanks {
  using State = surefoot::Vec<2>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<2>;

  surefoot::SimulatorInfo info() const {
    return {.name = "tanks",
            .states = {{"upper", "m"}, {"lower", "m"}},
            .inputs = {{"pump", "V"}},
            .outputs = {{"upper_m", "m"}, {"lower_m", "m"}},
            .parameters = {{"gain", "m/(s V)", 0.0016, 0.0002, 0.01},
                           {"upper_drain", "1/s", 0.03, 0.003, 0.3},
                           {"lower_drain", "1/s", 0.03, 0.003, 0.3}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {p[0] * u[0] - p[1] * x[0], p[1] * x[0] - p[2] * x[1]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

/// Six recordings of 400 rows, one a second, with an inflow in steps.
std::vector<Recording> two_tanks_log() {
  std::vector<Recording> log;
  for (std::uint64_t r = 0; r < 6; ++r) {
    Recording one = toys::blank_recording(TwoTanks{}.info(), 400, 1);
    one.name = "rec_" + std::to_string(r);
    surefoot::Rng rng(11, r);
    for (Eigen::Index row = 0; row < 400; ++row) {
      one.inputs(0, row) = row % 60 == 0 ? 1 + 4 * rng.uniform() : one.inputs(0, row - 1);
    }
    one.outputs = simulate_augmented(TwoTanks{}, {.parameters = {0.002, 0.1, 0.1}}, one).outputs;
    for (double& level : one.outputs.reshaped()) level += 0.002 * rng.normal();
    log.push_back(std::move(one));
  }
  return log;
}

TEST_SUITE("log_doctor") {
  TEST_CASE("a fault of one recording is found there, and not where all have it") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    CHECK_FALSE(find_fault_of_one(inputs, fit_log(inputs, log)));
    log[1].outputs.row(1) *= -1;
    const auto found = find_fault_of_one(inputs, fit_log(inputs, log));
    REQUIRE(found);
    CHECK(*found->recording == 1);
    CHECK(found->repairs[0].kind == LogFaultKind::sign);
    CHECK(found->repairs[0].channel.index == 1);
  }

  TEST_CASE("a fault is found where missing physics leaves more of its recording than of any other") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log({}, 5);
    surefoot::Augmented sticky;
    sticky.parameters = {90, 8};
    sticky.effects = {{"coulomb_friction", "omega", {}, {}, {3.0}}};
    log[2].outputs = simulate_augmented(toys::Servo{}, sticky, log[2]).outputs;  // it alone shows it
    const double before = fit_log(inputs, log).error[2];
    log[2].outputs.row(0).swap(log[2].outputs.row(1));
    const LogFit swapped = fit_log(inputs, log);
    const auto found = find_fault_of_one(inputs, swapped);
    REQUIRE(found);
    CHECK(*found->recording == 2);
    CHECK(found->repairs[0].kind == LogFaultKind::swap);
    double others = 0;
    for (const std::size_t r : {0, 1, 3, 4}) others = std::max(others, swapped.error[r]);
    CHECK(before > inputs.criteria.decisive * others);  // still unlike the others once it is repaired
  }

  TEST_CASE("what a model misses by less than in most recordings is not odd, whatever mends it") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const LogFit fit = fit_log(inputs, toys::servo_log(toys::dry_friction()));
    const Repairs flipped{{.kind = LogFaultKind::sign, .channel = {false, 1}}};
    int odd = 0;
    for (std::size_t r = 0; r < 6; ++r) odd += is_odd(fit, r, flipped) ? 1 : 0;
    CHECK(odd == 3);
    LogFit small = fit;
    small.residuals[0] *= 1e-3;
    CHECK_FALSE(is_odd(small, 0, flipped));
    small.residuals[0] *= 1e6;
    CHECK(is_odd(small, 0, flipped));
  }

  TEST_CASE("the sign of what moves by less than the model is off is not asked for") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    const LogFit fit = fit_log(inputs, log);
    const Repairs flipped{{.kind = LogFaultKind::sign, .channel = {false, 0}}},
        swapped{{.kind = LogFaultKind::swap, .channel = {false, 0}, .other = {false, 1}}};
    CHECK(moves_beyond_misfit(fit, 2, flipped));
    LogFit still = fit;
    still.bound.recordings[2].outputs.row(0) *= 0.5 * fit.typical[0] / log[2].outputs.row(0).norm();
    CHECK_FALSE(moves_beyond_misfit(still, 2, flipped));
    CHECK(moves_beyond_misfit(still, 2, swapped));
    auto& readings = still.bound.recordings[2].outputs;  // one of it: where it ends
    readings.row(0).setConstant(std::numeric_limits<double>::quiet_NaN());
    readings(0, 299) = -2 * fit.typical[0];
    CHECK(moves_beyond_misfit(still, 2, flipped));
    readings(0, 299) = -0.5 * fit.typical[0];
    CHECK_FALSE(moves_beyond_misfit(still, 2, flipped));
  }

  TEST_CASE("where sizes of residuals differ between recordings, a large one says less of a fault") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const auto log = toys::servo_log();
    LogFit fit = fit_log(inputs, log);
    CHECK(spread_of_others(fit, 0).degrees == 12);  // all alike
    const Repairs flip{{.kind = LogFaultKind::sign, .channel = {false, 1}}};
    const ResidualRows good = fit.residuals[0];
    fit.residuals[0] *= 10;
    CHECK(spread_of_others(fit, 0).degrees == 12);  // its own size is not asked
    CHECK(spread_of_others(fit, 1).degrees < 12);
    const double alike = effect_of(fit, 0, flip, good, spread_of_others(fit, 0)).log_odds;
    for (std::size_t r = 1; r < 6; ++r) fit.residuals[r] *= r % 2 == 0 ? 4 : 0.25;
    const SpreadOfSizes spread = spread_of_others(fit, 0);
    CHECK(spread.degrees < 3);
    CHECK(effect_of(fit, 0, flip, good, spread).log_odds < alike);
  }

  TEST_CASE("a few readings that a repair brings only half way to the others may be of no such machine at all") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const LogFit fit = fit_log(inputs, toys::servo_log());
    const Repairs flip{{.kind = LogFaultKind::sign, .channel = {false, 1}}};
    const auto over_unlike = [&](Eigen::Index rows, double share_of_size) {
      ResidualRows after(2, rows);
      for (Eigen::Index row = 0; row < rows; ++row) {
        after.col(row) = (row % 2 == 0 ? share_of_size : -share_of_size) * fit.size;
      }
      return effect_of(fit, 0, flip, after, spread_of_others(fit, 0)).over_unlike;
    };
    const double of_repairs = std::log(static_cast<double>(repairs_to_try(fit.bound.info).size()));
    CHECK(over_unlike(2, 0.3) < of_repairs);
    CHECK(over_unlike(2, 0.02) > of_repairs);   // as near as the others
    CHECK(over_unlike(200, 0.3) > of_repairs);  // as far off, but that often no chance
    CHECK(over_unlike(200, 1.5) < 0);
    ResidualRows one(2, 1);
    one << 1, 1;
    CHECK(log_likelihood_if_unlike(fit, one, 2) ==
          doctest::Approx(-std::log(fit.size[0] / fit.typical[0] * fit.size[1] / fit.typical[1]) -
                          std::log(2 * 3.14159265) - 1));
  }

  TEST_CASE("a log that fits is not searched for faults of all recordings") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    CHECK_FALSE(find_fault_of_all(inputs, fit_log(inputs, log)));
    for (auto& recording : log) recording.outputs *= 180 / 3.14159265;
    const auto found = find_fault_of_all(inputs, fit_log(inputs, log));
    REQUIRE(found);
    CHECK_FALSE(found->recording);
    CHECK(found->repairs[0].kind == LogFaultKind::degrees);
  }

  TEST_CASE(
      "a model that fits may have bent to a fault: it is searched for at a bound, and asked for if it was named") {
    const Parallel parallel = serially();
    LogDoctorInputs inputs = toys::servo_doctor(parallel);
    auto log = toys::servo_log(toys::dry_friction());
    for (auto& recording : log) recording.inputs *= 180 / 3.14159265;
    LogFit fit = fit_log(inputs, log);
    fit.hypothesis.parameters = Eigen::Vector2d(90, 8);
    fit.typical *= 1e-3;  // as good as it gets
    REQUIRE(worst_output_error(fit) < inputs.criteria.poor_fit);
    CHECK_FALSE(find_fault_of_all(inputs, fit));
    LogFit bent = fit;
    bent.hypothesis.parameters[1] = 40;
    CHECK(find_fault_of_all(inputs, bent));
    inputs.named = {{.kind = "angle_unit", .channel = "goal"}};
    const auto found = find_fault_of_all(inputs, fit);
    REQUIRE(found);
    CHECK(found->repairs[0].kind == LogFaultKind::degrees);
    CHECK(found->repairs[0].channel.input);
    inputs.named = {{.kind = "sign_flipped", .channel = "theta_rad"}};
    CHECK_FALSE(find_fault_of_all(inputs, fit));
  }

  TEST_CASE("columns whose exchange takes parameters off their bounds need not be all that is wrong") {
    const Parallel parallel = serially();
    const auto bind = [](std::vector<Recording> some) { return bind_simulator(TwoCarts{}, std::move(some)); };
    const LogDoctorInputs inputs{bind, [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
    std::vector<Recording> log;
    for (int r = 0; r < 6; ++r) {
      Recording one = toys::blank_recording(TwoCarts{}.info(), 200, 0.05);
      one.name = "rec_" + std::to_string(r);
      for (Eigen::Index row = 0; row < 200; ++row) {
        const double t = one.time[row];
        one.inputs(0, row) = std::cos(t + r);
        one.inputs(1, row) = 2 * std::cos(2 * t + r);
        const double missed = 0.9 * std::sin(3 * t);  // physics that the model lacks
        one.outputs(1, row) = std::sin(t + r) - std::sin(r) + missed;
        one.outputs(0, row) = std::sin(2 * t + r) - std::sin(r) - missed;
      }
      log.push_back(std::move(one));
    }
    const auto found = find_fault_of_all(inputs, fit_log(inputs, log));
    REQUIRE(found);
    CHECK(found->repairs[0].kind == LogFaultKind::swap);
    for (Recording& one : log) one.outputs.row(0).swap(one.outputs.row(1));
    CHECK_FALSE(find_fault_of_all(inputs, fit_log(inputs, log)));
  }

  TEST_CASE("columns in each other's place are found though the model bends to them") {
    const auto bind = [](std::vector<Recording> some) { return bind_simulator(TwoTanks{}, std::move(some)); };
    const Parallel parallel = serially();
    const LogDoctorInputs inputs{bind, [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
    std::vector<Recording> log = two_tanks_log();
    CHECK_FALSE(find_fault_of_all(inputs, fit_log(inputs, log)));
    for (Recording& one : log) one.outputs.row(0).swap(one.outputs.row(1));
    const LogFit fit = fit_log(inputs, log);
    CHECK(worst_output_error(fit) < 0.2);  // one tank follows the other
    const auto found = find_fault_of_all(inputs, fit);
    REQUIRE(found);
    CHECK(found->repairs[0].kind == LogFaultKind::swap);
  }

  TEST_CASE("that a model cannot be simulated in steps of a row is no fault of the clock") {
    struct StiffServo : toys::Servo {
      surefoot::SimulatorInfo info() const {
        surefoot::SimulatorInfo info = Servo::info();
        info.parameters[0] = {"stiffness", "1/s^2", 4e5, 4e5, 4e5};
        return info;
      }
    };
    const Parallel parallel = serially();
    LogDoctorInputs inputs = toys::servo_doctor(parallel);
    inputs.bind = [](std::vector<surefoot::Recording> some) { return bind_simulator(StiffServo{}, std::move(some)); };
    const LogFit fit = fit_log(inputs, toys::servo_log());
    CHECK_FALSE(fit.error[0] < 1e4);  // in milliseconds it stands still instead, which explains nothing
    CHECK_FALSE(find_fault_of_all(inputs, fit));
  }

  TEST_CASE("just a thousand times slower than all others is milliseconds, though noise hides most of it") {
    std::vector<surefoot::Recording> log;
    surefoot::Rng rng(3);
    for (int r = 0; r < 5; ++r) {
      surefoot::Recording recording;
      recording.time.setLinSpaced(4000, 0, 3.999);
      recording.inputs.setConstant(1, 4000, 1 + 0.1 * r);
      recording.inputs.rightCols(2000) *= 0.2;
      recording.initial = recording.initial_scale = Eigen::VectorXd::Zero(1);
      recording.outputs.setZero(1, 4000);
      recording.outputs = simulate_augmented(toys::LeakyTank{}, {}, recording).outputs;
      for (double& reading : recording.outputs.row(0)) reading += 0.4 * rng.normal();
      log.push_back(std::move(recording));
    }
    log[2].time *= 1000;
    const auto bind = [](std::vector<surefoot::Recording> some) {
      return bind_simulator(toys::LeakyTank{}, std::move(some));
    };
    const Parallel parallel = serially();
    const LogDoctorInputs inputs{bind, [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
    const auto found = find_fault_of_one(inputs, fit_log(inputs, log));
    REQUIRE(found);
    CHECK(found->recording == 2);
    CHECK(found->repairs.front().kind == LogFaultKind::time_unit);
    log[2].time *= 3;  // another setting of the logger as well
    CHECK_FALSE(find_fault_of_one(inputs, fit_log(inputs, log)));
  }

  TEST_CASE("the effect of a repair is the odds for it") {
    const Parallel parallel = serially();
    const LogDoctorInputs inputs = toys::servo_doctor(parallel);
    const auto log = toys::servo_log();
    const LogFit fit = fit_log(inputs, log);
    const Repairs flip{{.kind = LogFaultKind::sign, .amount = -1}};
    const auto version = repaired(fit.bound, log[0], flip);
    const RepairEffect effect = effect_of(fit, 0, flip, resimulate(fit, 0, version).residuals, {12, 1});
    CHECK(effect.log_odds < -50);
    CHECK(effect.log_ratio < 0);
  }
}

}  // namespace
