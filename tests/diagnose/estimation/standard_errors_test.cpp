// Standard errors: what they are worth, and what they say of parameters that trade off.
#include "surefoot/diagnose/estimation/standard_errors.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/estimation/noisy_tanks.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::LeakyTank;

// Share of repetitions in which the truth is within two standard errors.
double coverage(double memory) {
  int within = 0;
  constexpr int repetitions = 100;
  for (int k = 0; k < repetitions; ++k) {
    const BoundSimulator bound =
        bind_simulator(LeakyTank{}, tanks(4, 200, 1.5, 0.7, 0.02, memory, 10 + static_cast<std::uint64_t>(k)));
    const FitProblem problem = problem_of(4, 0.02);
    const Fit fitted = fit(bound, nominal_hypothesis(bound), problem, serially());
    const StandardErrors errors = standard_errors(bound, fitted.hypothesis, problem, serially());
    REQUIRE(errors.deviation.size() == 2);
    within += std::abs(fitted.hypothesis.parameters[0] - 1.5) < 2 * errors.deviation[0] ? 1 : 0;
    within += std::abs(fitted.hypothesis.parameters[1] - 0.7) < 2 * errors.deviation[1] ? 1 : 0;
  }
  return within / (2.0 * repetitions);
}

TEST_CASE("two standard errors cover the truth about as often as they should, also where noise is correlated") {
  for (const double memory : {0.0, 0.6}) {
    const double covered = coverage(memory);
    INFO("memory " << memory << ", covered " << covered);
    CHECK(covered > 0.85);
    CHECK(covered < 0.995);
  }
}

/// A tank whose gain is a product of two parameters.
struct TwiceUnknownTank {
  using State = Vec<1>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    SimulatorInfo info = LeakyTank{}.info();
    info.signals.clear();
    info.parameters = {{"gain", "m/s", 1, 0.2, 5}, {"factor", "1", 1, 0.2, 5}, {"leak", "1/s", 1, 0.2, 5}};
    return info;
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return State(p[0] * p[1] * u[0] - p[2] * x[0]);
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

TEST_CASE("parameters that only matter together are said to be unknown, however exact the recordings") {
  for (const double noise : {0.02, 1e-5}) {
    const BoundSimulator bound = bind_simulator(TwiceUnknownTank{}, tanks(4, 200, 1.5, 0.7, noise));
    const FitProblem problem = problem_of(4, noise);
    const Fit fitted = fit(bound, nominal_hypothesis(bound), problem, serially());
    const StandardErrors errors = standard_errors(bound, fitted.hypothesis, problem, serially());
    REQUIRE(errors.deviation.size() == 3);
    for (const int k : {0, 1}) CHECK(errors.deviation[k] > 0.4 * fitted.hypothesis.parameters[k]);
    CHECK(errors.correlation(0, 1) < -0.99);
    CHECK(errors.deviation[2] < 0.1 * noise / 0.02);
  }
}

/// The same, of which the simulation jumps by a thousandth of the noise, as where friction sticks a little sooner.
struct JumpyTank : TwiceUnknownTank {
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& p) const {
    constexpr double jump = 2e-5;
    return Output(jump * std::round(x[0] / jump + 1e4 * p[0]) - 1e4 * jump * p[0]);
  }
};

TEST_CASE("what jumps in a simulation is no knowledge of parameters that only matter together") {
  const BoundSimulator bound = bind_simulator(JumpyTank{}, tanks(4, 200, 1.5, 0.7, 0.02));
  const FitProblem problem = problem_of(4, 0.02);
  const Fit fitted = fit(bound, nominal_hypothesis(bound), problem, serially());
  const StandardErrors errors = standard_errors(bound, fitted.hypothesis, problem, serially());
  for (const int k : {0, 1}) CHECK(errors.deviation[k] > 0.3 * fitted.hypothesis.parameters[k]);
  CHECK(errors.deviation[2] < 0.1);
}

TEST_CASE("parameters that trade off are correlated, and a hypothesis without parameters has no errors") {
  const BoundSimulator bound = bind_simulator(LeakyTank{}, tanks(2, 200, 1.5, 0.7, 0.02));
  const StandardErrors errors = standard_errors(bound, nominal_hypothesis(bound), problem_of(2, 0.02), serially());
  CHECK(errors.correlation(0, 0) == doctest::Approx(1));
  CHECK(errors.correlation(0, 1) > 0.5);  // more inflow looks like less leakage's opposite
  BoundSimulator fixed = bound;
  for (ParameterInfo& parameter : fixed.info.parameters) parameter.fixed = true;
  CHECK(standard_errors(fixed, nominal_hypothesis(bound), problem_of(2, 0.02), serially()).variables.empty());
}

}  // namespace
}  // namespace surefoot::diagnosis
