// surefoot-calibrate compare with logs of the joints: which of them follows its goals in another way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/calibrate/joint_changes.hpp"
#include "apps/common/usage_error.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/apps/calibrate_walks.hpp"

using approach_program::ScratchFolder;
using approach_program::write_text;
using calibrate_test::calibrate;

namespace {

constexpr int joints = 6;

/// A servo with a stiffness of 24 N m/rad, by what it lags behind its goal.
struct Servo {
  double friction = 0.004, lag = 0.02, load = 0.01, current_load = 0.2;
};

/// Each joint walks at 1.7 Hz under a load that differs from one to the other and from cycle to cycle.
std::string joint_log(const std::vector<Servo>& servos, std::uint64_t seed, double seconds = 60) {
  std::string text = "t_s,enabled_1";
  for (const char* what : {"goal", "position", "current"}) {
    for (int j = 0; j < joints; ++j) {
      text += std::string(",") + what + "_j" + std::to_string(j) + (*what == 'c' ? "_A" : "_rad");
    }
  }
  surefoot::Rng rng(seed, 0);
  for (int i = 0; i < static_cast<int>(100 * seconds); ++i) {
    const double t = 0.01 * i;
    std::string goals, positions, currents;
    for (int j = 0; j < joints; ++j) {
      const Servo& servo = servos[static_cast<std::size_t>(j)];
      const double phase = 10.7 * t + j, angle = 0.3 * std::sin(phase), speed = 3.2 * std::cos(phase);
      const double load = servo.load * std::sin(phase + 0.5) + 0.002 * rng.normal();
      const double behind = servo.friction * std::tanh(speed / 0.05) + servo.lag * speed + load;
      char cell[96];
      std::snprintf(cell, sizeof cell, ",%.5f", angle + behind);
      goals += cell;
      std::snprintf(cell, sizeof cell, ",%.5f", angle);
      positions += cell;
      std::snprintf(cell, sizeof cell, ",%.5f", servo.current_load + 15 * servo.friction * std::tanh(speed / 0.05));
      currents += cell;
    }
    text += "\n" + std::to_string(t) + ",1" + goals + positions + currents;
  }
  return text + "\n";
}

calibrate_program::JointComparison compared(const std::vector<Servo>& before, const std::vector<Servo>& after) {
  const ScratchFolder folder;
  write_text(folder.file("old.csv"), joint_log(before, 1));
  write_text(folder.file("new.csv"), joint_log(after, 2));
  return calibrate_program::compare_joints(calibrate_program::read_joint_logs({folder.file("old.csv")}),
                                           calibrate_program::read_joint_logs({folder.file("new.csv")}));
}

}  // namespace

TEST_CASE("the joint whose friction grew is named, and that alone") {
  const std::vector<Servo> before(joints);
  std::vector<Servo> after = before;
  after[3].friction = 0.012;
  const auto result = compared(before, after);
  REQUIRE(result.changed.size() == 2);  // in its angle and in its current
  for (const calibrate_program::JointChange& one : result.changed) CHECK(one.joint == "j3");
  const auto friction = std::ranges::find(result.changed, "friction", &calibrate_program::JointChange::what);
  REQUIRE(friction != result.changed.end());
  CHECK(friction->difference() == doctest::Approx(0.008).epsilon(0.1));
  CHECK(result.common.empty());
  CHECK(calibrate_program::joint_report(result).find("j3: has more friction") != std::string::npos);
}

TEST_CASE("what changed alike in all joints is said of most joints") {
  const std::vector<Servo> before(joints), after(joints, Servo{.lag = 0.03});  // an empty battery
  const auto result = compared(before, after);
  CHECK(result.changed.empty());
  REQUIRE(result.common.size() == 1);
  CHECK(result.common[0].what == "lag");
  CHECK(result.common[0].difference() == doctest::Approx(0.01).epsilon(0.1));
}

TEST_CASE("joints that did not change are not named") {
  const std::vector<Servo> same(joints);
  const auto result = compared(same, same);
  CHECK(result.changed.empty());
  CHECK(result.common.empty());
  CHECK(calibrate_program::joint_report(result).find("none follows its goals in another way") != std::string::npos);
}

TEST_CASE("compare goes on to the joints, and says what their logs need") {
  const ScratchFolder folder;
  REQUIRE(calibrate("simulate --sequences 8 --seed 3 --out " + folder.file("old.csv")).code == 0);
  REQUIRE(calibrate("simulate --sequences 8 --seed 4 --out " + folder.file("new.csv")).code == 0);
  std::vector<Servo> servos(joints);
  write_text(folder.file("old_joints.csv"), joint_log(servos, 1, 20));
  servos[2].load = 0.01, servos[2].friction = 0.02;
  write_text(folder.file("new_joints.csv"), joint_log(servos, 2, 20));
  const std::string walks = "compare " + folder.file("old.csv") + " " + folder.file("new.csv") + " --out " +
                            folder.file("out") + " --old-joints " + folder.file("old_joints.csv") + " --new-joints ";
  const auto outcome = calibrate(walks + folder.file("new_joints.csv"));
  REQUIRE_MESSAGE(outcome.code == 0, outcome.output);
  CHECK(outcome.output.find("j2: has more friction") != std::string::npos);
  std::ifstream file(folder.file("out/compare.json"));
  const auto json = nlohmann::json::parse(file);
  CHECK(json["joints"]["changed"][0]["joint"] == "j2");
  const auto refused = calibrate(walks + folder.file("old.csv"));
  CHECK(refused.code == 2);
  CHECK(refused.output.find("is no log of joints") != std::string::npos);
  write_text(folder.file("short.csv"), joint_log(servos, 2, 4));
  CHECK(calibrate(walks + folder.file("short.csv")).output.find("less than two blocks") != std::string::npos);
}
