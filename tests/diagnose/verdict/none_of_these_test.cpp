// Probability that what was fitted is not all of it.
#include "surefoot/diagnose/verdict/none_of_these.hpp"

#include <doctest/doctest.h>

namespace surefoot::diagnosis {
namespace {

// A choice with errors of `times` the noise in six recordings of 500 independent readings, without effects ten times it.
double none(double times, double noise = 0.1) {
  SearchProblem problem;
  problem.scale.sigma = Eigen::VectorXd::Constant(1, 2.0);
  Selection selection;
  selection.candidates = 50;
  ErrorSquares& errors = selection.chosen.errors;
  const double floor = 0.1 / 2.0;
  errors.mean_squares = Eigen::MatrixXd::Constant(6, 1, times * times * floor * floor);
  errors.counts = Eigen::MatrixXd::Constant(6, 1, 500);
  errors.memory = Eigen::VectorXd::Ones(1);
  errors.least = Eigen::VectorXd::Constant(1, 0.01 * floor * floor);
  return probability_of_none(selection, Eigen::VectorXd::Constant(1, noise), problem);
}

TEST_CASE("errors at the noise leave next to no room for anything unknown, errors far above it little else") {
  CHECK(none(0.9) < 0.001);
  CHECK(none(1.0) < 0.001);
  CHECK(none(1.4) < 0.001);  // the form of an effect may be off a little
  CHECK(none(2.0) > 0.99);
}

TEST_CASE("where the noise is not known nothing is said") { CHECK(none(3, 0) == 0); }

}  // namespace
}  // namespace surefoot::diagnosis
