// Two links with dry friction in both joints, against equations of motion that are integrated from event to event.
#include "apps/diagnose/robot/simulate_robot.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "apps/diagnose/robot/robot_step.hpp"
#include "tests/diagnose_robot/small_robots.hpp"
#include "tests/support/two_links.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;
using two_links::LinkState, two_links::TwoLinks;

namespace {

// The arm of the tests without its drives, let go.
struct LetGo {
  ScratchFolder folder;
  Robot robot;
  RobotRecording recording;
  RobotPhysics physics;
  StartState start;
  static constexpr double seconds = 5, period = 0.01;

  explicit LetGo(const TwoLinks& links, double step) {
    const auto arm = robot_test::small_arm();
    robot_test::write_files(folder, arm, 31, 1);
    robot = robot_test::load(folder);
    robot.setup.step = step;
    for (RobotJoint& joint : robot.joints) joint.setup.kp = joint.setup.kd = joint.setup.limit = 0;
    physics = robot.nominal;
    for (std::size_t i = 0; i < 2; ++i) physics[i][Property::coulomb] = links.friction[i];
    const auto rows = static_cast<Eigen::Index>(std::lround(seconds / period)) + 1;
    recording.time = Eigen::VectorXd::LinSpaced(rows, 0, seconds);
    recording.angle.setZero(rows, 2);
    recording.goal.setZero(rows, 2);
    start = {Eigen::Vector2d(1.3, -0.8), Eigen::Vector2d::Zero()};
  }
};

TwoLinks with_friction() {
  TwoLinks links;
  links.friction = {0.25, 0.12};
  return links;
}

}  // namespace

TEST_CASE("two links with dry friction in both joints move as a fine integration from event to event says") {
  const TwoLinks links = with_friction();
  const LetGo arm(links, 1e-4);
  const Eigen::MatrixXd readings = simulate_robot(arm.robot, arm.recording, arm.start, arm.physics);
  LinkState state{{arm.start.angle[0], arm.start.angle[1]}, {0, 0}};
  std::array<int, 2> slides = links.choose(state);
  double farthest = 0;
  int rests = 0;
  for (Eigen::Index k = 1; k < readings.rows(); ++k) {
    for (int s = 0; s < 50; ++s) {
      const std::array<int, 2> before = slides;
      links.advance(state, slides, LetGo::period / 50);
      rests += slides[0] != before[0] || slides[1] != before[1] ? 1 : 0;
    }
    for (Eigen::Index i = 0; i < 2; ++i)
      farthest = std::max(farthest, std::abs(readings(k, i) - state.q[static_cast<std::size_t>(i)]));
  }
  CHECK(rests > 10);
  CHECK(farthest < 1e-6);
}

TEST_CASE("a joint that friction holds does not move at all, and without a drive energy never grows") {
  const TwoLinks links = with_friction();
  const LetGo arm(links, 0.001);
  RobotStep step(arm.robot, arm.recording, arm.start, arm.physics);
  const auto energy = [&] { return links.energy({{step.q[0], step.q[1]}, {step.v[0], step.v[1]}}); };
  const double lowest = links.energy({});
  double before = energy();
  const double all = before - lowest;
  double grown = 0;
  int held = 0;
  for (int k = 0; k < 5000; ++k) {
    const Eigen::VectorXd angle = step.q, was = step.v;
    step.step(std::min<Eigen::Index>(k / 10, arm.recording.time.size() - 1), k * 1e-3, 1e-3);
    for (Eigen::Index i = 0; i < 2; ++i) {
      if (step.v[i] != 0 || was[i] != 0) continue;
      ++held;
      CHECK(step.q[i] == angle[i]);
    }
    grown = std::max(grown, energy() - before);
    before = energy();
  }
  CHECK(held > 500);
  CHECK(grown < 1e-6 * all);  // what steps of 1 ms make of a motion that loses nothing
  CHECK(before < links.energy({{1.3, -0.8}, {0, 0}}));
}
