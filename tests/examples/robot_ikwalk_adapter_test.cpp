// Against a stand-in for the header of Rhoban/IKWalk; the real one is used where -DIKWALK_DIR says where it is.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "examples/sigmaban/robot/walk_engine/ikwalk_adapter.hpp"
#include "tests/examples/robot_gaits.hpp"

using namespace sigmaban;

TEST_CASE("the adapter hands over orders and parameters, and the joints back") {
  WalkParameters p;
  p.support_phase_ratio = 0.2;
  p.extra_left.x = 0.01;
  p.extra_right.roll = 0.02;
  IkWalkAdapter walk(p, 0.25);
  const JointTargets targets = there(walk.step({0.03, 0.02, 0.1, 0.9}, 0.1));
  const std::array<double, 12> expected{0.03, 0.02, 0.1, 0.9, 0.093, 0.035, 1.7, 0.15, 0.01, 0.02, 0.2, 0};
  CHECK(targets.array() == expected);
  CHECK(walk.phase() == doctest::Approx(0.42));
}

TEST_CASE("the adapter keeps its phase where the library fails or gives no number") {
  IkWalkAdapter walk({}, 0.25);
  CHECK_FALSE(walk.step({.forward = 2}, 0.1));
  CHECK_FALSE(walk.step({.forward = -2}, 0.1));
  CHECK_FALSE(walk.step({.turn = NAN}, 0.1));
  CHECK_FALSE(walk.step({}, HUGE_VAL));
  CHECK(walk.phase() == 0.25);
  WalkParameters p;
  p.support_phase_ratio = 2;
  CHECK_FALSE(IkWalkAdapter(p).step({}, 0.1));
}
