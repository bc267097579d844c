// Fits with a growing horizon, against the valleys of a long one.
#include "surefoot/diagnose/estimation/growing_horizon.hpp"

#include <doctest/doctest.h>

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
  CHECK(beginnings(bound, 0.25).recordings[0].rows() == rows / 4);
  CHECK(beginnings(bound, 1).recordings[0].outputs == bound.recordings[0].outputs);
  CHECK(beginnings(bound, 0).recordings[0].rows() == 2);
  CHECK(beginnings(bound, 0.25).recordings[0].initial == bound.recordings[0].initial);
}

}  // namespace
}  // namespace surefoot::diagnosis
