// A robot in the physics engine that stops while it walks, asked to or for a fault: it sits, and does not fall.
#include <doctest/doctest.h>

#include <algorithm>

#include "examples/sigmaban/robot/servos/soft_start.hpp"
#include "examples/sigmaban/robot/walk/gait.hpp"
#include "examples/sigmaban/robot/walk/sitting_pose.hpp"
#include "examples/sigmaban/twin/walking_twin.hpp"
#include "surefoot/core/rng.hpp"

using namespace sigmaban;

namespace {

JointTargets targets_of(const std::array<double, 12>& a) {
  return {{a[0], a[1], a[2], a[3], a[4], a[5]}, {a[6], a[7], a[8], a[9], a[10], a[11]}};
}

/// Height of the hips at the end [m]; 0 where it fell. After so many `ticks` of walking it sits down, with or without
/// ending its step before.
double sits(const surefoot::Vec<3>& speed, int ticks, bool ends_step) {
  const WalkParameters walk = twin_walk();
  Twin twin;
  SplineWalk engine(walk);
  Gait gait({.rise_s = 0.5, .slowing = {0.02, 0.01, 0.15}});
  const double dt = twin.parameters().order_period;
  JointTargets goals = *engine.step({.enabled = 0}, 0);
  twin.reset(goals);
  double before = 1;
  for (int i = 0; gait.stage() != GaitStage::done; ++i) {
    if (i == ticks && !ends_step) break;  // as after a fault of a servo
    if (i == ticks) gait.stop_quickly();  // as after a signal
    const bool stepping = gait.stage() == GaitStage::step_in_place || gait.stage() == GaitStage::walk;
    if (stepping && engine.phase() < before) gait.begin_cycle(gait.speed() + (speed - gait.speed()) / 2);
    before = engine.phase();
    goals = engine.step(gait.advance(dt), stepping ? dt : 0).value_or(goals);
    twin.drive(goals);
  }
  const auto from = goals.array(), to = sitting_pose(walk)->array();
  for (double time = 0; time < 1.3; time += dt) {  // as the servos are told to
    std::array<double, 12> now{};
    for (std::size_t j = 0; j < now.size(); ++j) {
      now[j] = dynamixel::SoftStart{{}, from[j], 1.2}(to[j], dynamixel::from_seconds(time));
    }
    twin.drive(targets_of(now));
  }
  return twin.fallen() ? 0 : twin.height();
}

}  // namespace

TEST_CASE("a walk that stops at any time sits down and does not fall") {
  surefoot::Rng rng(5);
  for (int i = 0; i < 24; ++i) {
    const surefoot::Vec<3> speed(rng.uniform(-0.02, 0.04), rng.uniform(-0.02, 0.02), rng.uniform(-0.2, 0.2));
    const double height = sits(speed, 50 + static_cast<int>(rng.below(500)), i % 2 == 0);
    CAPTURE(i);
    CHECK(height > 0);
    CHECK(height < 0.17);  // standing, it is 0.21
  }
}
