// Fits with a growing horizon, against the valleys of a long one.
#include "surefoot/diagnose/estimation/growing_horizon.hpp"

#include <doctest/doctest.h>

#include "falling_pendulum.hpp"
#include "swing.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a stiffness so wrong that the swings are out of step is found with a growing horizon") {
  check_escapes(grown_fit);
}

TEST_CASE("a fit that is no worse stays as it is") { check_keeps_good_fit(grown_fit); }

TEST_CASE("beginnings have the wanted share of the rows, and two at least") {
  const BoundSimulator bound = swing();
  const Eigen::Index rows = bound.recordings[0].rows();
  CHECK(beginnings(bound, {0}, 0.25).recordings[0].rows() == rows / 4);
  CHECK(beginnings(bound, {0}, 1).recordings[0].outputs == bound.recordings[0].outputs);
  CHECK(beginnings(bound, {0}, 0).recordings[0].rows() == 2);
  CHECK(beginnings(bound, {0}, 0.25).recordings[0].initial == bound.recordings[0].initial);
  CHECK(beginnings(bound, {}, 0.25).recordings[0].rows() == rows);
}

TEST_CASE("to which side a pendulum falls is told by its first rows, not by its first reading") {
  const BoundSimulator bound = bind_simulator(toys::FallingPendulum{}, toys::falling_log(true, 10, 0.25));
  FitProblem problem;
  problem.recordings = {0, 1, 2, 3, 4, 5};
  problem.weighting.sigma = Vec<1>(0.02);
  Hypothesis known = nominal_hypothesis(bound);
  known.parameters = Vec<2>(10, 0.25);
  const Hypothesis found = with_grown_initial_states(bound, known, problem.recordings, problem, serially());
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    problem.recordings = {r};
    CAPTURE(r);
    CHECK(loss_of(bound, found, problem, serially()) < 1.2);
  }
}

}  // namespace
}  // namespace surefoot::diagnosis
