// Where differences smaller than the noise decide what comes later.
#include "surefoot/diagnose/estimation/sensitive_starts.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "falling_pendulum.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

std::vector<std::size_t> rows_of_first(bool near_top) {
  const BoundSimulator bound = bind_simulator(toys::FallingPendulum{}, toys::falling_log(near_top, 9, 0.3));
  const Hypothesis nominal = nominal_hypothesis(bound);
  Integration close = bound.integration;
  close.follow = 0.5;
  return sensitive_rows(bound, nominal, 0, simulate(bound, nominal, 0, close).states);
}

TEST_CASE("a pendulum that falls from its upper rest is cut once it falls, one that hangs is not") {
  CHECK(rows_of_first(false).empty());
  const std::vector<std::size_t> rows = rows_of_first(true);
  REQUIRE_FALSE(rows.empty());
  CHECK(rows.front() >= 25);   // of 400: the first border
  CHECK(rows.front() <= 100);  // it has fallen after two seconds
  std::size_t before = 0;
  for (const std::size_t row : rows) {
    CHECK(row - before >= 20);
    before = row;
  }
  CHECK(400 - before >= 20);
}

/// A car whose compass is poor, seen from above by a camera that is not.
struct Car {
  using State = Vec<3>;
  using Input = Vec<2>;
  using Output = Vec<3>;
  SimulatorInfo info() const {
    return {.name = "car",
            .states = {{"x", "m"}, {"y", "m"}, {"yaw", "rad"}},
            .inputs = {{"speed", "m/s"}, {"turn", "rad/s"}},
            .outputs = {{"x_m", "m", 0.02}, {"y_m", "m", 0.002}, {"yaw_rad", "rad", 0.2}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*p*/) const {
    return {u[0] * std::cos(x[2]), u[0] * std::sin(x[2]), u[1]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

TEST_CASE("a heading that its sensor hardly tells is told by where it leads: a car is not cut") {
  Recording log = toys::blank_recording(Car{}.info(), 400, 0.05);
  log.inputs.row(0).setConstant(1);
  for (Eigen::Index row = 0; row < 400; ++row) log.inputs(1, row) = 0.2 * std::sin(0.4 * log.time[row]);
  const BoundSimulator bound = bind_simulator(Car{}, {log});
  const Hypothesis nominal = nominal_hypothesis(bound);
  CHECK(sensitive_rows(bound, nominal, 0, simulate(bound, nominal, 0, bound.integration).states).empty());
}

TEST_CASE("nothing is missing from a pendulum that falls to either side") {
  const Diagnosis found = diagnose(toys::FallingPendulum{}, toys::falling_log(true, 10, 0.25), {}, Serial{}, 1);
  INFO(found.sentence);
  CHECK(found.verdict == Verdict::parameters_only);
  CHECK(found.log_faults.empty());  // a whole recording that goes the other way is as one in another unit
  CHECK(found.noise_ratio < 1.3);
  CHECK(found.parameters[0].fit.value == doctest::Approx(10).epsilon(0.02));
  bool remarked = false;
  for (const Remark& remark : found.remarks) {
    remarked = remarked || (remark.recording.starts_with("fall_") && remark.text.find("parts") != std::string::npos);
  }
  CHECK(remarked);
}

}  // namespace
}  // namespace surefoot::diagnosis
