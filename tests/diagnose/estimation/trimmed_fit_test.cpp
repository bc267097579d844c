// Fits that some recordings bend, and that the others lead out.
#include "surefoot/diagnose/estimation/trimmed_fit.hpp"

#include <doctest/doctest.h>

#include "falling_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a pendulum that falls to the wrong side in a recording bends the fit; the others lead it out") {
  const BoundSimulator bound = bind_simulator(toys::FallingPendulum{}, toys::falling_log(true, 10, 0.25));
  FitProblem problem;
  problem.recordings = {0, 1, 2, 3, 4, 5};
  problem.weighting.sigma = Vec<1>(0.02);
  problem.max_iterations = 50;
  Hypothesis start = nominal_hypothesis(bound);
  for (const Vec<2>& parameters : {Vec<2>(13, 0.3), Vec<2>(12, 0.6), Vec<2>(10.5, 0.6)}) {
    start.parameters = parameters;
    const Fit bent = fit(bound, start, problem, serially());
    REQUIRE(bent.loss > 10);
    const Fit led_out = trimmed_fit(bound, bent, problem, serially());
    CHECK(led_out.loss < 1.1);
    CHECK(led_out.hypothesis.parameters[0] == doctest::Approx(10).epsilon(0.005));
    CHECK(led_out.hypothesis.parameters[1] == doctest::Approx(0.25).epsilon(0.02));
    CHECK(trimmed_fit(bound, led_out, problem, serially()).loss == led_out.loss);  // no worse: stays as it is
  }
}

}  // namespace
}  // namespace surefoot::diagnosis
