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
  std::optional<bool> linear = {};
  SimulatorInfo info() const {
    SimulatorInfo info = LeakyTank::info();
    info.inputs[0].linear = linear;
    return info;
  }
};

/// Recordings with noise of 5 mm of a tank whose valve is moved smoothly and is truly interpolated, or held.
std::vector<Recording> tank_logs(bool linear) {
  std::vector<Recording> recordings;
  Rng rng(3);
  for (int r = 0; r < 4; ++r) {
    Recording recording = toys::tank_recording(r, 120);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      recording.inputs(0, i) = std::sin((3 + 0.4 * r) * recording.time[i]) + 0.5 * std::sin(7 * recording.time[i]);
    }
    recording.outputs = simulate_augmented(SaidTank{{}, linear}, toys::machine({1.1, 0.9}, {}), recording).outputs;
    for (double& level : recording.outputs.reshaped()) level += 0.005 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

/// What is chosen from held on: whether the valve is interpolated, and whether the fit was replaced.
std::pair<bool, bool> chosen(const SaidTank& tank, bool truth) {
  const BoundSimulator bound = bind_simulator(tank, tank_logs(truth));
  SearchProblem problem;
  problem.fit.recordings = {0, 1, 2, 3};
  problem.fit.weighting.sigma.setConstant(1, 0.005);
  problem.scale.sigma.setConstant(1, 0.1);
  Fit fitted = fit(bound, nominal_hypothesis(bound), problem.fit, serially());
  const double before = fitted.loss;
  const bool changed = choose_holds(bound, fitted, problem, serially());
  const auto& linear = problem.fit.integration.linear;
  return {changed && fitted.loss < before, !linear.empty() && linear[0]};
}

TEST_CASE("an input is interpolated if recordings say so, and only where the model does not say") {
  CHECK(chosen(SaidTank{}, true) == std::pair{true, true});
  CHECK(chosen(SaidTank{}, false) == std::pair{false, false});
  CHECK(chosen(SaidTank{{}, false}, true) == std::pair{false, false});
  CHECK(chosen(SaidTank{{}, true}, false) == std::pair{false, false});
}

TEST_CASE("what was interpolated is held again if recordings say so") {
  const BoundSimulator bound = bind_simulator(SaidTank{}, tank_logs(false));
  SearchProblem problem;
  problem.fit.recordings = {0, 1, 2, 3};
  problem.fit.weighting.sigma.setConstant(1, 0.005);
  problem.scale.sigma.setConstant(1, 0.1);
  problem.fit.integration.linear = {true};
  Fit fitted = fit(bound, nominal_hypothesis(bound), problem.fit, serially());
  CHECK(choose_holds(bound, fitted, problem, serially()));
  CHECK_FALSE(problem.fit.integration.linear[0]);
}

TEST_CASE("a diagnosis of smooth inputs finds nothing missing, and says that they are interpolated") {
  const Diagnosis found = diagnose(SaidTank{}, tank_logs(true), DiagnoseOptions{}, surefoot::Threads{}, 1);
  CHECK(found.effects.empty());
  REQUIRE(found.linear_inputs.size() == 1);
  CHECK(found.linear_inputs[0]);
  CHECK(std::ranges::any_of(found.remarks, [](const Remark& one) {
    return one.text.find("input valve goes straight from row to row") != std::string::npos;
  }));
  CHECK(found.parameters[0].fit.value == doctest::Approx(1.1).epsilon(0.01));
}

}  // namespace
}  // namespace surefoot::diagnosis
