// Calibration from a start that may be far off.
#include "surefoot/diagnose/estimation/calibrate.hpp"

#include <doctest/doctest.h>

#include <set>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::LeakyTank;

BoundSimulator tanks(double noise) {
  std::vector<Recording> recordings;
  Rng rng(4);
  for (int r = 0; r < 3; ++r) {
    Recording recording = toys::tank_recording(r, 120);
    recording.outputs = simulate_augmented(LeakyTank{}, toys::machine({3.1, 0.4}), recording).outputs;
    for (double& level : recording.outputs.reshaped()) level += noise * rng.normal();
    recordings.push_back(recording);
  }
  return bind_simulator(LeakyTank{}, recordings);
}

TEST_CASE("parameters are found from afar, and residuals are weighted by what is left of them") {
  const BoundSimulator bound = tanks(0.02);
  FitProblem problem;
  problem.recordings = {0, 1, 2};
  const Fit fitted = calibrate(bound, nominal_hypothesis(bound), problem, 8, 1, serially());
  CHECK(fitted.hypothesis.parameters[0] == doctest::Approx(3.1).epsilon(0.02));
  CHECK(fitted.hypothesis.parameters[1] == doctest::Approx(0.4).epsilon(0.02));
  CHECK(problem.weighting.sigma[0] == doctest::Approx(0.02).epsilon(0.1));
  for (const double scale : problem.weighting.scale) CHECK(scale == doctest::Approx(1).epsilon(0.2));
}

TEST_CASE("stated noise is the least that residuals are weighted by") {
  BoundSimulator bound = tanks(0.001);
  bound.info.outputs[0].noise = 0.05;
  FitProblem problem;
  problem.recordings = {0, 1, 2};
  calibrate(bound, nominal_hypothesis(bound), problem, 2, 1, serially());
  CHECK(problem.weighting.sigma[0] == 0.05);
}

TEST_CASE("scattered points fill the bounds, one in each stratum of each parameter") {
  const BoundSimulator bound = tanks(0);
  const auto points = scattered(bound, nominal_hypothesis(bound), 10, 7);
  REQUIRE(points.size() == 10);
  for (Eigen::Index i = 0; i < 2; ++i) {
    std::set<int> strata;
    for (const Hypothesis& one : points) {
      const double share = std::log(one.parameters[i] / 0.2) / std::log(5 / 0.2);
      strata.insert(static_cast<int>(share * 10));
    }
    CHECK(strata.size() == 10);
  }
}

TEST_CASE("a model that no parameters let run is refused") {
  struct Hopeless : LeakyTank {
    State derivative(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const {
      return State::Constant(std::nan(""));
    }
  };
  const BoundSimulator bound = bind_simulator(Hopeless{}, {toys::tank_recording(0, 50)});
  FitProblem problem;
  problem.recordings = {0};
  CHECK_THROWS_AS(calibrate(bound, nominal_hypothesis(bound), problem, 2, 1, serially()), DiagnoseError);
}

}  // namespace
}  // namespace surefoot::diagnosis
