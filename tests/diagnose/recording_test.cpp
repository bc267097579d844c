// Recordings, and parts of them.
#include "surefoot/diagnose/recording.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/small_simulators.hpp"

namespace surefoot {
namespace {

TEST_CASE("the duration is from the first row to the last, and 0 without two rows") {
  CHECK(toys::tank_recording(1, 21).duration() == doctest::Approx(1));
  CHECK(toys::blank_recording(toys::LeakyTank{}.info(), 1, 0.05).duration() == 0);
  CHECK(Recording{}.duration() == 0);
}

TEST_CASE("a part has the rows of the whole, its constants, and a name that says which") {
  Recording whole = toys::tank_recording(1, 20);
  whole.constants["area_m2"] = 2;
  const Recording part = part_of(whole, 5, 12, Eigen::VectorXd::Constant(1, 0.7), Eigen::VectorXd::Constant(1, 0.1));
  CHECK(part.name == "tank 1[5:12]");
  CHECK(part.rows() == 7);
  CHECK(part.time[0] == whole.time[5]);
  CHECK(part.inputs == whole.inputs.middleCols(5, 7));
  CHECK(part.outputs == whole.outputs.middleCols(5, 7));
  CHECK(part.constants.at("area_m2") == 2);
}

TEST_CASE("the initial state of a part is to be estimated, unless it is that of the whole") {
  const Recording whole = toys::tank_recording(1, 20);
  const Eigen::VectorXd initial = Eigen::VectorXd::Constant(1, 0.7), scale = Eigen::VectorXd::Constant(1, 0.1);
  CHECK(part_of(whole, 5, 12, initial, scale).initial == initial);
  CHECK(part_of(whole, 5, 12, initial, scale).initial_scale == scale);
  CHECK(part_of(whole, 0, 12, initial, scale).initial == whole.initial);
  CHECK(part_of(whole, 0, 12, initial, scale).initial_scale == whole.initial_scale);
}

}  // namespace
}  // namespace surefoot
