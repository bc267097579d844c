// Fits under the guidance of the readings, against the valleys of a long horizon.
#include "surefoot/diagnose/estimation/guided_fit.hpp"

#include <doctest/doctest.h>

#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a stiffness so wrong that the swings are out of step is found under guidance") { check_escapes(guided_fit); }

TEST_CASE("guidance makes no good fit worse") { check_keeps_good_fit(guided_fit); }

TEST_CASE("guidance asks nothing of a model without measured states") {
  BoundSimulator bound = swing();
  Hypothesis far = nominal_hypothesis(bound);
  far.parameters[0] = 12;
  const FitProblem problem = swing_problem();
  const Fit trapped = fit(bound, far, problem, serially());
  bound.structure.output_of = {-1, -1};
  CHECK(guided_fit(bound, trapped, far, problem, serially()).loss == trapped.loss);
}

}  // namespace
}  // namespace surefoot::diagnosis
