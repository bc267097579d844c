// Starts of recordings, which are fitted along with the terms.
#include "apps/diagnose/robot/starts.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "apps/diagnose/robot/search_terms.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

constexpr double misread = 0.15;                     // [rad/s]
constexpr double stated = 20, hidden = 0.5;          // [N m], limits of a drive that does not reach its goals
constexpr double upper_speed = 0.4, encoder = 1e-4;  // [rad/s], [rad]

// The log as it would be if the upper joint's drive gave less than it should, with the speed that it begins with read
// wrongly.
struct MisreadArm {
  ScratchFolder folder;
  Robot robot;
  Evidence evidence;
  RobotPhysics physics;

  MisreadArm() : robot(robot_test::arm_with_limit(folder, stated)), evidence(robot), physics(robot.nominal) {
    physics[0][Property::torque_limit] = 1 - hidden / stated;
    plants::Random random(7);
    for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
      robot_test::add_recording(evidence, folder.file(file));
      RobotRecording& recording = evidence.recordings.back();
      StartState start = start_of(evidence.motions.back());
      start.speed[0] = upper_speed;
      recording.angle = simulate_robot(robot, recording, start, physics);
      for (double& reading : recording.angle.reshaped()) reading += random.normal(encoder);
      evidence.motions.back() = smooth(recording);
      evidence.motions.back().v(0, 0) = upper_speed + misread;
    }
    prepare(evidence);
  }
};

}  // namespace

TEST_CASE("derivatives by the start are those that differences give") {
  const MisreadArm arm;
  const RobotRecording& recording = arm.evidence.recordings.front();
  const StartState start = arm.evidence.starts.front();
  const auto derivatives = simulation_derivatives(arm.robot, recording, start, arm.physics, {});
  const Eigen::MatrixXd at_start = simulate_robot(arm.robot, recording, start, arm.physics);
  for (Eigen::Index s = 0; s < 4; ++s) {
    constexpr double step = 1e-5;
    StartState moved = start;
    (s < 2 ? moved.angle[s] : moved.speed[s - 2]) += step;
    const Eigen::MatrixXd difference = (simulate_robot(arm.robot, recording, moved, arm.physics) - at_start) / step;
    double off = 0;
    for (Eigen::Index j = 0; j < 2; ++j)
      off += (derivatives[static_cast<std::size_t>(j)].by_start.col(s) - difference.col(j)).squaredNorm();
    CHECK(std::sqrt(off / difference.squaredNorm()) < 0.05);
  }
}

TEST_CASE("a start that is read wrongly is fitted, no further than its reading is uncertain") {
  const Eigen::VectorXd by{{1, 0.8, 0.6, 0.4}}, term{{0, 1, 0, 1}};
  const auto eliminated = [&](double deviation) {
    std::vector<Eigen::MatrixXd> columns{term};
    std::vector<Eigen::VectorXd> errors{3 * by};
    eliminate_start({0}, {by}, Eigen::VectorXd::Constant(1, deviation), Eigen::VectorXd::Zero(1),
                    Eigen::VectorXd::Constant(1, 100), 0, columns, errors);
    return std::pair<Eigen::VectorXd, Eigen::VectorXd>(errors[0], columns[0]);
  };
  CHECK(eliminated(100).first.norm() < 1e-3);
  CHECK(std::abs(eliminated(100).second.dot(by)) < 1e-3);  // what a term does that starts do as well is no evidence
  CHECK((eliminated(1e-4).first - 3 * by).norm() < 1e-3);
  CHECK((eliminated(1e-4).second - term).norm() < 1e-3);
}

TEST_CASE("a drive at its limit does not forget a start that was misread: it is fitted and takes no name") {
  MisreadArm arm;
  CHECK(rms_by_joint(arm.evidence, errors_of(arm.evidence, arm.physics))[0] > 100 * encoder);
  const auto starts = fitted_starts(arm.evidence, arm.physics);
  CHECK(starts[0].speed[0] == doctest::Approx(upper_speed).epsilon(0.1));  // the lower joint begins as uncertainly
  CHECK(rms_by_joint(arm.evidence, errors_of(arm.evidence, arm.physics, starts))[0] < 1.2 * encoder);
  const SearchResult found = search_terms(arm.evidence, [](const std::string&, double) {});
  for (std::size_t t = 0; t < found.set.size(); ++t) {
    const Term& term = arm.evidence.terms[t];
    const bool limit = term.property == Property::torque_limit && term.joints == std::vector<int>{0};
    CHECK((found.set[t] != 0) == limit);
  }
}
