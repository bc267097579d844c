// A spring at a joint, which the model lacks.
#include <doctest/doctest.h>

#include <algorithm>

#include "apps/diagnose/robot/search_terms.hpp"
#include "apps/diagnose/robot/simulate_robot.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

TEST_CASE("a spring at a joint is found with its stiffness, and nothing else") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 34);
  const Robot robot = robot_test::load(folder);
  Evidence evidence(robot);
  RobotPhysics physics = robot.nominal;
  constexpr double stiffness = 1.5, noise = 1e-4;  // [N m/rad], [rad]
  surefoot::Rng rng(35);
  physics[1][Property::stiffness] = stiffness;
  for (const char* file : {"rec_1.csv", "rec_2.csv"}) {
    robot_test::add_recording(evidence, folder.file(file));
    RobotRecording& recording = evidence.recordings.back();
    recording.angle = simulate_robot(robot, recording, start_of(evidence.motions.back()), physics);
    for (double& reading : recording.angle.reshaped()) reading += noise * rng.normal();
    evidence.motions.back() = smooth(recording);
  }
  prepare(evidence);
  const SearchResult found = search_terms(evidence, [](const std::string&, double) {});
  for (std::size_t t = 0; t < found.set.size(); ++t) {
    if (found.set[t] == 0) continue;
    CHECK(evidence.terms[t].property == Property::stiffness);
    CHECK(evidence.terms[t].joints == std::vector<int>{1});
    CHECK(found.theta[static_cast<Eigen::Index>(t)] == doctest::Approx(stiffness).epsilon(0.03));
  }
  CHECK(std::ranges::count(found.set, 1) == 1);
}
