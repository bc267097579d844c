// Whether inputs are held or interpolated between rows, where the model does not say.
#include "surefoot/diagnose/selection/choose_holds.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

/// A tank of which it is said, or not, how its valve goes between rows.
struct SaidTank : toys::LeakyTank {
  std::optional<InputHold> hold = {};
  SimulatorInfo info() const {
    SimulatorInfo info = LeakyTank::info();
    info.inputs[0].hold = hold;
    return info;
  }
};

/// Recordings with noise of 5 mm of a tank whose valve moves smoothly and is truly like that between rows.
std::vector<Recording> tank_logs(InputHold truth) {
  std::vector<Recording> recordings;
  Rng rng(3);
  for (int r = 0; r < 4; ++r) {
    Recording recording = toys::tank_recording(r, 120);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      const double t = recording.time[i];
      recording.inputs(0, i) = std::sin((3 + 0.4 * r) * t) + 0.5 * std::sin(7 * t) + 3 * std::sin(24 * t);
    }
    recording.outputs = simulate_augmented(SaidTank{{}, truth}, toys::machine({1.1, 0.9}, {}), recording).outputs;
    for (double& level : recording.outputs.reshaped()) level += 0.005 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

SearchProblem tank_problem() {
  SearchProblem problem;
  problem.fit.recordings = {0, 1, 2, 3};
  problem.fit.weighting.sigma.setConstant(1, 0.005);
  problem.scale.sigma.setConstant(1, 0.1);
  return problem;
}

/// What is chosen, beginning with `from`, where the truth is otherwise or not; checks that the fit follows.
InputHold chosen(const SaidTank& tank, InputHold truth, InputHold from = InputHold::zero_order) {
  const BoundSimulator bound = bind_simulator(tank, tank_logs(truth));
  SearchProblem problem = tank_problem();
  problem.fit.integration.inputs = {from};
  Fit fitted = fit(bound, nominal_hypothesis(bound), problem.fit, serially());
  const double before = fitted.loss;
  const bool changed = choose_holds(bound, fitted, problem, serially());
  const InputHold now = problem.fit.integration.inputs[0];
  CHECK(changed == (now != from));
  CHECK((fitted.loss < before) == changed);
  return now;
}

TEST_CASE("recordings say what an input is between rows, where the model does not") {
  using enum InputHold;
  for (const InputHold truth : {zero_order, linear, before, band_limited}) {
    for (const InputHold from : {zero_order, linear, before, band_limited}) {
      CHECK(chosen(SaidTank{}, truth, from) == truth);
    }
    CHECK(chosen(SaidTank{{}, zero_order}, truth) == zero_order);
  }
}

TEST_CASE("what the model says to go straight may turn out to be smooth, and nothing else") {
  using enum InputHold;
  const auto said_linear = [](InputHold truth, InputHold from) {
    const SaidTank tank{{}, linear};
    const BoundSimulator bound = bind_simulator(tank, tank_logs(truth));
    SearchProblem problem = tank_problem();
    problem.fit.integration.inputs = {from};
    Fit fitted = fit(bound, nominal_hypothesis(bound), problem.fit, serially());
    choose_holds(bound, fitted, problem, serially());
    return hold_of(bound.info, problem.fit.integration.inputs, 0);
  };
  CHECK(said_linear(band_limited, zero_order) == band_limited);
  CHECK(said_linear(linear, zero_order) == linear);
  CHECK(said_linear(linear, band_limited) == linear);
  CHECK(said_linear(zero_order, zero_order) == linear);
}

/// A dancer roller between two rollers whose speeds are measured: only their difference moves it.
struct Dancer {
  using State = Vec<1>;
  using Input = Vec<2>;
  using Output = Vec<1>;
  std::optional<InputHold> hold = {};
  SimulatorInfo info() const {
    return {.name = "dancer",
            .states = {{"x", "m"}},
            .inputs = {{"fast", "m/s", hold}, {"slow", "m/s", hold}},
            .outputs = {{"x_m", "m"}},
            .parameters = {{"gain", "1", 1, 0.5, 2}, {"back", "1/s", 1, 0.5, 2}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return State(p[0] * (u[0] - u[1]) - p[1] * x[0]);
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

TEST_CASE("inputs of which only the difference acts are interpolated together") {
  std::vector<Recording> recordings;
  Rng rng(8);
  for (int r = 0; r < 4; ++r) {
    Recording recording = toys::blank_recording(Dancer{}.info(), 150, 0.05);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      const double t = recording.time[i], both = 8 * t;  // speeding up: half a row late this is much
      recording.inputs(0, i) = both + 0.3 * std::sin((3 + 0.4 * r) * t);
      recording.inputs(1, i) = both;
    }
    const auto machine = toys::machine({1.1, 0.9}, {});
    recording.outputs = simulate_augmented(Dancer{InputHold::linear}, machine, recording).outputs;
    for (double& position : recording.outputs.reshaped()) position += 0.0005 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  const BoundSimulator bound = bind_simulator(Dancer{}, recordings);
  SearchProblem problem = tank_problem();
  problem.fit.weighting.sigma.setConstant(0.0005);
  Fit fitted = fit(bound, nominal_hypothesis(bound), problem.fit, serially());
  CHECK(choose_holds(bound, fitted, problem, serially()));
  CHECK(problem.fit.integration.inputs == std::vector<InputHold>{InputHold::linear, InputHold::linear});
}

TEST_CASE("what stands still in most rows is not interpolated") {
  std::vector<Recording> recordings = tank_logs(InputHold::linear);
  for (Recording& recording : recordings) {  // as measured smoothly, but logged only every third row
    for (Eigen::Index row = 0; row < recording.rows(); ++row)
      recording.inputs(0, row) = recording.inputs(0, row - row % 3);
  }
  const BoundSimulator bound = bind_simulator(SaidTank{}, recordings);
  SearchProblem problem = tank_problem();
  Fit fitted = fit(bound, nominal_hypothesis(bound), problem.fit, serially());
  choose_holds(bound, fitted, problem, serially());
  const auto& holds = problem.fit.integration.inputs;
  CHECK((holds.empty() || holds[0] != InputHold::linear));
}

TEST_CASE("a diagnosis of smooth inputs finds nothing missing, and says that they are interpolated") {
  const Diagnosis found = diagnose(SaidTank{}, tank_logs(InputHold::linear), DiagnoseOptions{}, surefoot::Threads{}, 1);
  CHECK(found.effects.empty());
  CHECK(found.input_holds == std::vector<InputHold>{InputHold::linear});
  CHECK(std::ranges::any_of(found.remarks, [](const Remark& one) {
    return one.text.find("input valve goes straight from row to row") != std::string::npos;
  }));
  CHECK(found.parameters[0].fit.value == doctest::Approx(1.1).epsilon(0.01));
}

}  // namespace
}  // namespace surefoot::diagnosis
