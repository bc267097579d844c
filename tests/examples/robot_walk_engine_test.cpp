#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"
#include "tests/examples/robot_gaits.hpp"

using namespace sigmaban;

namespace {

double largest_difference(const LegJoints& a, const LegJoints& b) {
  const auto x = JointTargets{a, {}}.array(), y = JointTargets{b, {}}.array();
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

/// 100,000 in a debug build; SUREFOOT_FUZZ_RUNS asks for another count.
int fuzz_runs() {
  const char* runs = std::getenv("SUREFOOT_FUZZ_RUNS");
  return runs != nullptr ? std::atoi(runs) : 100'000;
}

}  // namespace

TEST_CASE("a spline goes through its knots with their slopes and breaks where two share a time") {
  constexpr std::array<Knot, 4> knots{{{0, 1, 2}, {0.5, 3, -1}, {0.5, 3, 4}, {1, 0, 0}}};
  CHECK(evaluate_spline(knots, 0) == 1);
  CHECK(evaluate_spline(knots, 0.5) == 3);
  CHECK(evaluate_spline(knots, 1) == 0);
  CHECK(evaluate_spline(knots, -1) == 1);
  CHECK(evaluate_spline(knots, 2) == 0);
  constexpr double h = 1e-7;
  CHECK(std::abs((evaluate_spline(knots, h) - 1) / h - 2) < 1e-5);
  CHECK(std::abs((3 - evaluate_spline(knots, 0.5 - h)) / h + 1) < 1e-5);
  CHECK(std::abs((evaluate_spline(knots, 0.5 + h) - 3) / h - 4) < 1e-5);
  constexpr std::array<Knot, 3> jump{{{0, 1, 0}, {0.5, 1, 0}, {0.5, 2, 0}}};
  CHECK(evaluate_spline(jump, 0.5) == 2);  // the later knot counts, and no width is divided by
  constexpr std::array<Knot, 2> line{{{0, 1, 2}, {2, 5, 2}}};
  CHECK(evaluate_spline(line, 0.5) == doctest::Approx(2));
}

TEST_CASE("inverse kinematics undo forward kinematics") {
  const LegLengths leg;
  surefoot::Rng rng(6, 1);
  for (int i = 0; i < 20'000; ++i) {
    LegJoints q{rng.uniform(-1, 1), rng.uniform(-1, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(0.05, 1.5)};
    q.ankle_pitch = rng.uniform(-0.7, 0.7) - q.knee - q.hip_pitch;
    q.ankle_roll = rng.uniform(-0.5, 0.5);
    const FootPose foot = foot_of(leg, q);
    const auto joints = leg_inverse_kinematics(leg, foot);
    if (!joints) {
      CHECK(foot.ground.z() + leg.ankle_to_ground * foot.axes(2, 2) >= 0);  // the only excuse
      continue;
    }
    const FootPose again = foot_of(leg, *joints);
    REQUIRE((again.ground - foot.ground).norm() < 2e-8);  // [m]
    REQUIRE((again.axes - foot.axes).norm() < 1e-7);
  }
}

TEST_CASE("the engine puts both feet where their paths are") {
  surefoot::Rng rng(6, 2);
  int reached = 0;
  for (int i = 0; i < 20'000; ++i) {
    const WalkSettings s = absurd_settings(rng);
    SplineWalk walk(s.parameters, rng.uniform());
    const double phase = walk.phase();
    const auto targets = walk.step(s.orders, 0.01);
    if (!targets) continue;
    ++reached;
    const FeetPoses feet = feet_poses(s.parameters, s.orders, phase);
    REQUIRE((foot_of(s.parameters.leg, targets->left).ground - feet.left.ground).norm() < 1e-7);
    REQUIRE((foot_of(s.parameters.leg, targets->left).axes - feet.left.axes).norm() < 1e-6);
    REQUIRE((foot_of(s.parameters.leg, targets->right).ground - feet.right.ground).norm() < 1e-7);
    REQUIRE((foot_of(s.parameters.leg, targets->right).axes - feet.right.axes).norm() < 1e-6);
  }
  CHECK(reached > 4'000);
}

TEST_CASE("a leg reaches its full length and nothing beyond") {
  const LegLengths leg;
  const auto straight = [&](double reach) {
    return leg_inverse_kinematics(leg, {{0, 0, -reach}, Eigen::Matrix3d::Identity()});
  };
  CHECK(largest_difference(there(straight(leg.sum())), {}) < 1e-7);
  CHECK_FALSE(straight(leg.sum() + 1e-6));
  CHECK_FALSE(straight(0));
  CHECK_FALSE(straight(-leg.sum()));
  CHECK_FALSE(straight(leg.ankle_to_ground + 0.01));  // the shin is longer than the thigh by more than that
}

TEST_CASE("the phase advances with the frequency and stays in [0, 1)") {
  SplineWalk walk({}, 0.25);
  REQUIRE(walk.step({}, 0.1));
  CHECK(walk.phase() == doctest::Approx(0.42));
  REQUIRE(walk.step({}, 0.5));
  CHECK(walk.phase() == doctest::Approx(0.27));
  REQUIRE(walk.step({}, -0.2));
  CHECK(walk.phase() == doctest::Approx(0.93));
  CHECK(advance_phase(0, -1e-20) == 0);
  CHECK(SplineWalk({}, 3.75).phase() == 0.75);
}

TEST_CASE("what cannot be reached moves neither the phase nor later targets") {
  SplineWalk walk({}, 0.3), untouched({}, 0.3);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK_FALSE(walk.step({.forward = 0.5}, 0.01));
  CHECK_FALSE(walk.step({.left = -0.6}, 0.01));
  CHECK_FALSE(walk.step({.turn = NAN}, 0.01));
  CHECK_FALSE(walk.step({.enabled = infinity}, 0.01));
  CHECK_FALSE(walk.step({}, infinity));
  CHECK_FALSE(walk.step({}, NAN));
  CHECK(walk.phase() == 0.3);
  CHECK(there(walk.step({}, 0.01)).array() == there(untouched.step({}, 0.01)).array());
}

TEST_CASE("parameters that make no sense are unreachable, the ends of their ranges are not") {
  const auto works = [](auto change) {
    WalkSettings s;
    change(s.parameters);
    SplineWalk walk(s.parameters);
    int reached = 0;
    for (int i = 0; i < 200; ++i) reached += walk.step({0.02, 0.01, 0.1}, 0.01) ? 1 : 0;
    CHECK((reached == 0 || reached == 200));
    return reached > 0;
  };
  CHECK(works([](WalkParameters&) {}));
  CHECK(works([](WalkParameters& p) { p.support_phase_ratio = 1; }));
  CHECK(works([](WalkParameters& p) { p.swing_pause = 0.5; }));
  CHECK(works([](WalkParameters& p) { p.leg.ankle_to_ground = 0; }));
  CHECK(works([](WalkParameters& p) { p.frequency = 0; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.support_phase_ratio = 1.01; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.support_phase_ratio = -0.01; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.swing_pause = 0.51; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.leg = {0, 0, 0}; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.leg.hip_to_knee = 0; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.leg.knee_to_ankle = -0.1; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.rise = NAN; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.extra_right.yaw = HUGE_VAL; }));
  CHECK_FALSE(works([](WalkParameters& p) { p.trunk_pitch = 1.57; }));
  CHECK_FALSE(SplineWalk({}, NAN).step({}, 0.01));
}

TEST_CASE("no parameters and orders, however absurd, give a number that is not finite") {
  surefoot::Rng rng(6, 3);
  int reached = 0;
  const int runs = fuzz_runs();
  for (int i = 0; i < runs; ++i) {
    const WalkSettings s = absurd_settings(rng);
    const double phase = rng.below(50) == 0 ? absurd_number(rng, 1) : rng.uniform();
    const double duration = rng.below(50) == 0 ? absurd_number(rng, 1) : rng.uniform(0, 0.1);
    SplineWalk walk(s.parameters, phase);
    const double before = walk.phase();
    const auto targets = walk.step(s.orders, duration);
    if (targets) {
      ++reached;
      REQUIRE(all_finite(*targets));
      REQUIRE(walk.phase() >= 0);
      REQUIRE(walk.phase() < 1);
    } else {
      REQUIRE((walk.phase() == before || std::isnan(before)));
    }
  }
  MESSAGE(runs << " parameter sets, " << reached << " reached");
  CHECK(reached > runs / 5);
}

TEST_CASE("targets are continuous over the cycle") {
  for (const double support : {0.0, 0.2, 0.7}) {
    for (const double pause : {0.0, 0.2}) {
      for (const WalkOrders& orders :
           {WalkOrders{0.02, 0, 0.1}, WalkOrders{-0.02, 0.02, -0.2}, WalkOrders{0, -0.02, 0}}) {
        WalkParameters p;
        p.support_phase_ratio = support;
        p.swing_pause = pause;
        constexpr int steps = 20'000;
        double largest = 0;
        JointTargets last = there(walk_targets(p, orders, (steps - 1.0) / steps));
        for (int i = 0; i < steps; ++i) {
          const JointTargets now = there(walk_targets(p, orders, static_cast<double>(i) / steps));
          largest =
              std::max({largest, largest_difference(last.left, now.left), largest_difference(last.right, now.right)});
          last = now;
        }
        CHECK(largest < 40.0 / steps);  // no joint is faster than 40 rad/cycle
      }
    }
  }
}

TEST_CASE("mirrored orders give mirrored joints half a cycle later") {
  WalkParameters p, q;
  p.trunk_roll = 0.04;
  p.trunk_y_offset = 0.005;
  p.swing_roll = 0.05;
  p.extra_left = {0.003, 0.002, 0.001, 0.02, 0.01, 0.03};
  q = p;
  q.trunk_roll = -p.trunk_roll;
  q.trunk_y_offset = -p.trunk_y_offset;
  q.extra_left = {};
  q.extra_right = {0.003, -0.002, 0.001, -0.02, 0.01, -0.03};
  for (int i = 0; i < 1000; ++i) {
    const double phase = i / 1000.0;
    const JointTargets a = there(walk_targets(p, {0.02, 0.015, 0.1}, phase));
    const JointTargets b = there(walk_targets(q, {0.02, -0.015, -0.1}, advance_phase(phase, 0.5)));
    REQUIRE(largest_difference(a.left, mirrored(b.right)) < 1e-9);
    REQUIRE(largest_difference(a.right, mirrored(b.left)) < 1e-9);
  }
}

TEST_CASE("without gain the robot stands still") {
  SplineWalk walk;
  const WalkOrders orders{0.02, 0.01, 0.1, 0};
  const JointTargets first = there(walk.step(orders, 0.01));
  for (int i = 0; i < 100; ++i) CHECK(there(walk.step(orders, 0.01)).array() == first.array());
  CHECK(largest_difference(first.left, mirrored(first.right)) < 1e-12);
}
