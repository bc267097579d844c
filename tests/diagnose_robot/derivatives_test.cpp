#include "apps/diagnose/robot/derivatives.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "apps/diagnose/robot/torque_residual.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

struct Arm {
  ScratchFolder folder;
  Robot robot;
  RobotRecording recording;
  Motion motion;

  explicit Arm(bool torque) {
    auto arm = robot_test::small_arm();
    arm.torque_driven = torque;
    robot_test::write_files(folder, arm, 21, 1);
    robot = robot_test::load(folder);
    Evidence evidence(robot);
    robot_test::add_recording(evidence, folder.file("rec_1.csv"));
    recording = evidence.recordings[0];
    motion = evidence.motions[0];
  }
};

std::vector<PhysicsEntry> entries_for(bool torque) {
  std::vector<PhysicsEntry> entries;
  for (const PropertyInfo& info : property_table()) {
    for (int j = 0; j < 2; ++j) {
      if ((torque ? info.torque_drive : info.position_drive) && (j == 1 || !is_of_pair(info.property)))
        entries.push_back({info.property, j});
    }
  }
  return entries;
}

// Largest relative distance of derivatives from differences, over entries; `at` evaluates. Names those that are far
// off.
template <class At>
double distance(const std::vector<JointDerivatives>& derivatives, const std::vector<PhysicsEntry>& entries,
                RobotPhysics physics, double step, const At& at, std::string& worst) {
  double farthest = 0;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    double& value = physics[static_cast<std::size_t>(entries[e].joint)][entries[e].property];
    const double here = value;
    value = here + step;
    const Eigen::MatrixXd more = at(physics);
    const bool from_zero = here < step;  // where less is not possible
    value = from_zero ? here : here - step;
    const Eigen::MatrixXd difference = (more - at(physics)) / (from_zero ? step : 2 * step);
    value = here;
    double square = 0, off = 0;
    for (std::size_t j = 0; j < derivatives.size(); ++j) {
      const auto place = std::ranges::find(derivatives[j].entries, e) - derivatives[j].entries.begin();
      for (Eigen::Index k = 0; k < difference.rows(); ++k) {
        const double expected = difference(k, static_cast<Eigen::Index>(j));
        if (!std::isfinite(expected)) continue;
        square += expected * expected;
        off += std::pow(derivatives[j].by(k, place) - expected, 2);
      }
    }
    const double size = std::sqrt(square / static_cast<double>(derivatives.front().by.rows()));
    if (size < 1e-5) continue;  // rounding: a shift along the axis does nothing
    farthest = std::max(farthest, std::sqrt(off / square));
    if (std::sqrt(off / square) > 0.03)
      worst += std::string(info_of(entries[e].property).effect) + "." + info_of(entries[e].property).parameter + "@" +
               std::to_string(entries[e].joint) + ": " + std::to_string(std::sqrt(off / square)) + "; ";
  }
  return farthest;
}

}  // namespace

TEST_CASE("derivatives of a simulation are those that differences give, for every property") {
  const Arm arm(false);
  const auto entries = entries_for(false);
  const StartState start = start_of(arm.motion);
  const auto at = [&](const RobotPhysics& physics) { return simulate_robot(arm.robot, arm.recording, start, physics); };
  std::string worst;
  RobotPhysics physics(2);
  SUBCASE("with dry friction alone") {}
  SUBCASE("with something of everything") {
    for (const PropertyInfo& info : property_table()) {
      if (!info.position_drive || info.property == Property::backlash) continue;
      const bool timing = is_of_timing(info.property), limit = info.property == Property::torque_limit;
      physics[0][info.property] = physics[1][info.property] = timing ? 0.0005 : limit ? 0.9 : 0.01;
    }
  }
  physics[0][Property::coulomb] = 0.4;
  physics[1][Property::coulomb] = 0.1;
  const auto derivatives = simulation_derivatives(arm.robot, arm.recording, start, physics, entries);
  const double off = distance(derivatives, entries, physics, 1e-5, at, worst);
  CAPTURE(worst);
  CHECK(off < 0.2);  // of lags, at zero and not; others are within 0.1
}

TEST_CASE("derivatives of the torque that is left are those that differences give") {
  const Arm arm(true);
  const auto entries = entries_for(true);
  RobotPhysics physics(2);
  for (const PropertyInfo& info : property_table()) {
    if (info.torque_drive) physics[0][info.property] = physics[1][info.property] = 0.05;
  }
  const auto rigid = rigid_derivatives(arm.robot, arm.motion, physics, entries);
  const auto derivatives = torque_derivatives(arm.robot, arm.motion, physics, entries, rigid);
  std::string worst;
  const double off = distance(
      derivatives, entries, physics, 1e-5,
      [&](const RobotPhysics& moved) { return torque_residual(arm.robot, arm.motion, moved); }, worst);
  CAPTURE(worst);
  CHECK(off < 1e-3);
}
