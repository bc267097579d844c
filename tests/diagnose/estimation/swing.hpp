// A mass on a spring and a recording of ten swings, for tests of fits with many valleys.
#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {

/// A mass on a spring, let go: with the wrong stiffness whole swings fit again, but not as well.
struct Swing {
  using State = Vec<2>;
  using Input = Vec<0>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "swing",
            .states = {{"x", "m"}, {"v", "m/s"}},
            .inputs = {},
            .outputs = {{"x_m", "m"}},
            .parameters = {{"stiffness", "1/s^2", 4, 0.5, 50}, {"rest", "m", 0, -1, 1}}};
  }
  State derivative(const State& x, const Input& /*u*/, const Eigen::VectorXd& p) const {
    return {x[1], -p[0] * (x[0] - p[1])};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

inline BoundSimulator swing() {
  Recording recording = toys::blank_recording(Swing{}.info(), 200, 0.05);
  recording.initial[0] = 1;
  recording.outputs = simulate_augmented(Swing{}, toys::machine({4, 0.1}), recording).outputs;
  return bind_simulator(Swing{}, {recording});
}

inline FitProblem swing_problem() {
  FitProblem problem;
  problem.recordings = {0};
  problem.weighting.sigma = Eigen::VectorXd::Ones(1);
  return problem;
}

/// Stiffness and rest are found from stiffnesses whose plain fits are trapped. `escape`: as guided_fit and grown_fit.
template <class Escape>
void check_escapes(Escape escape) {
  const BoundSimulator bound = swing();
  const FitProblem problem = swing_problem();
  for (const double stiffness : {1.5, 7.0, 12.0}) {
    CAPTURE(stiffness);
    Hypothesis start = nominal_hypothesis(bound);
    start.parameters[0] = stiffness;
    const Fit trapped = fit(bound, start, problem, serially());
    REQUIRE(std::abs(trapped.hypothesis.parameters[0] - 4) > 0.5);
    const Fit free = escape(bound, trapped, start, problem, serially());
    CHECK(free.hypothesis.parameters[0] == doctest::Approx(4).epsilon(1e-3));
    CHECK(free.hypothesis.parameters[1] == doctest::Approx(0.1).epsilon(1e-2));
  }
}

/// A good fit to noisy readings stays as it is.
template <class Escape>
void check_keeps_good_fit(Escape escape) {
  BoundSimulator bound = swing();
  Rng rng(3);
  for (double& x : bound.recordings[0].outputs.reshaped()) x += 0.01 * rng.normal();
  const FitProblem problem = swing_problem();
  const Fit good = fit(bound, nominal_hypothesis(bound), problem, serially());
  const Fit same = escape(bound, good, nominal_hypothesis(bound), problem, serially());
  CHECK(same.hypothesis.parameters == good.hypothesis.parameters);
  CHECK(same.loss == good.loss);
}

}  // namespace surefoot::diagnosis
