// A delay is a lag and some damping where motions are slow; the search may come by them.
#include "apps/diagnose/robot/fewer_terms.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <utility>
#include <vector>

#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

constexpr double encoder = 2e-4;  // [rad]

// The log of a small arm with this at its lower joint.
struct LowerJoint {
  ScratchFolder folder;
  Robot robot;
  Evidence evidence;

  LowerJoint(Property property, double value) : robot(write_and_load(folder)), evidence(robot) {
    RobotPhysics physics = robot.nominal;
    physics[1][property] = value;
    plants::Random random(5);
    for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
      robot_test::add_recording(evidence, folder.file(file));
      RobotRecording& recording = evidence.recordings.back();
      recording.angle = simulate_robot(robot, recording, start_of(evidence.motions.back()), physics);
      for (double& reading : recording.angle.reshaped()) reading += random.normal(encoder);
      evidence.motions.back() = smooth(recording);
    }
    prepare(evidence);
  }
  static Robot write_and_load(const ScratchFolder& folder) {
    robot_test::write_files(folder, robot_test::small_arm(), 34);
    return robot_test::load(folder);
  }
  std::size_t term(Property property) const {
    for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
      const Term& one = evidence.terms[t];
      if (one.property == property && one.joints == std::vector<int>{1}) return t;
    }
    return evidence.terms.size();
  }
  // These terms at the lower joint, from these values on.
  Point fitted(std::initializer_list<std::pair<Property, double>> parts) const {
    const auto terms = static_cast<Eigen::Index>(evidence.terms.size());
    Point point{Eigen::VectorXd::Zero(terms), TermSet(evidence.terms.size(), 0), evidence.starts, {}};
    for (const auto& [property, value] : parts) {
      REQUIRE(term(property) < evidence.terms.size());
      point.set[term(property)] = 1;
      point.theta[static_cast<Eigen::Index>(term(property))] = value;
    }
    point.errors = errors_at(evidence, point.theta, point.starts);
    settle(evidence, model_at(point), 10, point);
    return point;
  }
  LinearModel model_at(const Point& point) const {
    RigidCache cache;
    return linearize(evidence, point.theta, point.starts, point.errors, cache);
  }
};

}  // namespace

TEST_CASE("a delay stays where a lag and damping stood in for a part of it") {
  constexpr double hidden = 0.03;  // [s]
  const LowerJoint arm(Property::delay, hidden);
  Point point = arm.fitted({{Property::delay, 0.01}, {Property::lag, 0.02}, {Property::viscous, 0.05}});
  while (do_with_fewer(arm.evidence, arm.model_at(point), point)) {
  }
  CHECK(std::ranges::count(point.set, 1) == 1);
  CHECK(point.set[arm.term(Property::delay)] == 1);
  CHECK(point.theta.sum() == doctest::Approx(hidden).epsilon(0.02));
}

TEST_CASE("what is needed stays") {
  const LowerJoint arm(Property::lag, 0.03);
  Point point = arm.fitted({{Property::delay, 0.002}, {Property::lag, 0.03}});
  while (do_with_fewer(arm.evidence, arm.model_at(point), point)) {
  }
  CHECK(point.set[arm.term(Property::lag)] == 1);
  const TermSet set = point.set;
  CHECK_FALSE(do_with_fewer(arm.evidence, arm.model_at(point), point));
  CHECK(point.set == set);
}
