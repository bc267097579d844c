// Fits under the guidance of the readings, against the valleys of a long horizon.
#include "surefoot/diagnose/estimation/guided_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <span>

#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a stiffness so wrong that the swings are out of step is found under guidance") { check_escapes(guided_fit); }

TEST_CASE("guidance makes no good fit worse") { check_keeps_good_fit(guided_fit); }

TEST_CASE("what guidance reaches over short horizons depends neither on the start nor on damping that is missing") {
  BoundSimulator bound = swing();
  Recording& recording = bound.recordings[0];
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {  // as of a damper: half of it is left after 14 s
    recording.outputs(0, row) = 0.1 + (recording.outputs(0, row) - 0.1) * std::exp(-0.05 * recording.time[row]);
  }
  const FitProblem problem = swing_problem();
  const std::span<const double> near = std::span(guided_horizons).first(2);
  for (const double stiffness : {1.5, 7.0, 12.0}) {
    CAPTURE(stiffness);
    Hypothesis start = nominal_hypothesis(bound);
    start.parameters[0] = stiffness;
    const Hypothesis reached = guided(bound, start, problem, near, serially());
    CHECK(reached.parameters[0] == doctest::Approx(4).epsilon(0.05));
    CHECK(std::abs(fit(bound, start, problem, serially()).hypothesis.parameters[0] - 4) > 0.5);
  }
}

TEST_CASE("guidance asks nothing of a model without measured states") {
  BoundSimulator bound = swing();
  Hypothesis far = nominal_hypothesis(bound);
  far.parameters[0] = 12;
  const FitProblem problem = swing_problem();
  const Fit trapped = fit(bound, far, problem, serially());
  bound.structure.output_of = {-1, -1};
  CHECK(guided_fit(bound, trapped, far, problem, serially()).loss == trapped.loss);
  CHECK(guided(bound, far, problem, guided_horizons, serially()).parameters == far.parameters);
}

}  // namespace
}  // namespace surefoot::diagnosis
