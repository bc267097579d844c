// surefoot-walk: gait, log, ball and joints by themselves, and the whole on virtual servos.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "examples/sigmaban/approach/approach.hpp"
#include "examples/sigmaban/robot/walk/ball.hpp"
#include "examples/sigmaban/robot/walk/durations.hpp"
#include "examples/sigmaban/robot/walk/gait.hpp"
#include "examples/sigmaban/robot/walk/joints_file.hpp"
#include "examples/sigmaban/robot/walk/walk_log.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"
#include "tests/support/program.hpp"

namespace sigmaban {
namespace {

using approach_program::ScratchFolder;

approach_program::Outcome surefoot_walk(const std::string& arguments) {
  return approach_program::run_command(SUREFOOT_BIN_DIR "/surefoot-walk " + arguments);
}

TEST_CASE("a gait rises, steps in place, walks, slows down and stands") {
  const surefoot::Vec<3> slowing(0.02, 0.01, 0.15), wanted(0.04, 0.0, 0.2);
  Gait gait({.slowing = slowing});
  SplineWalk engine;
  std::vector<GaitStage> seen{gait.stage()};
  surefoot::Vec<3> speed = surefoot::Vec<3>::Zero();
  bool first = true;
  double walked = 0, time = 0;
  for (; gait.stage() != GaitStage::done; time += 0.01) {
    REQUIRE(time < 30);
    if (first && gait.stage() != GaitStage::rise) gait.begin_cycle(wanted);
    const WalkOrders orders = gait.advance(0.01);
    const surefoot::Vec<3> now(orders.forward, orders.left, orders.turn);
    if (seen.back() != GaitStage::walk) CHECK(((speed - now).array() <= slowing.array() + 1e-12).all());
    speed = now;
    if (orders.enabled < 1) CHECK(speed.isZero());
    const double phase = engine.phase();
    REQUIRE(engine.step(orders, gait.stage() == GaitStage::rise ? 0 : 0.01));
    first = engine.phase() < phase || gait.stage() == GaitStage::rise;
    walked += gait.walking() ? 0.01 : 0;
    if (walked > 3) gait.stop();
    if (gait.stage() != seen.back()) seen.push_back(gait.stage());
  }
  CHECK(seen == std::vector{GaitStage::rise, GaitStage::step_in_place, GaitStage::walk, GaitStage::slow_down,
                            GaitStage::settle, GaitStage::done});
}

TEST_CASE("a gait that is stopped while it rises never steps") {
  Gait gait({.slowing = {0.02, 0.01, 0.15}});
  gait.stop();
  for (int i = 0; i < 1000 && gait.stage() != GaitStage::done; ++i) CHECK(gait.advance(0.01).enabled == 0);
  CHECK(gait.stage() == GaitStage::done);
}

TEST_CASE("percentiles of durations") {
  auto durations = std::make_unique<Durations>();
  for (int i = 1; i <= 1000; ++i) durations->add(i * 1e-6);
  durations->add(0.2);
  CHECK(durations->count() == 1001);
  CHECK(durations->percentile(0.5) == doctest::Approx(501e-6));
  CHECK(durations->percentile(0.99) == doctest::Approx(991e-6));
  CHECK(durations->longest() == 0.2);
  CHECK(durations->percentile(1) == 0.2);
}

TEST_CASE("a simulated ball moves as in the problem") {
  const Approach problem;
  const Approach::State start{0.7, 0.4, -1.0, 0.03, 0.01, -0.1};
  const surefoot::Rng rng(5);
  surefoot::Rng same = rng;
  const auto step = problem.step(start, Approach::Action{0.01, 0, 0.1}, same);
  SimulatedBall<Approach> ball(problem, {0.7 * std::cos(0.4), 0.7 * std::sin(0.4), -1.0}, rng);
  const surefoot::Vec<3> before = start.tail<3>(), speed = step.next.tail<3>();
  ball.see(before, before);
  const auto view = ball.see(speed, before);
  REQUIRE(view);
  CHECK(std::hypot(view->x, view->y) == doctest::Approx(step.next[0]));
  CHECK(std::atan2(view->y, view->x) == doctest::Approx(step.next[1]));
  CHECK(view->angle == doctest::Approx(step.next[2]));
}

TEST_CASE("a ball is read line by line, and forgotten") {
  const surefoot::Vec<3> none = surefoot::Vec<3>::Zero();
  const ScratchFolder folder;
  const auto file = folder.path() / "ball.txt";
  std::ofstream(file) << "0.5 0.1 0.2\nnonsense\n0.4 nan 0\n0.3 -0.1 0.1\n0.9 0.9";
  BallReader ball(file.string(), 0.5);
  std::optional<BallView> view;
  for (int i = 0; i < 100 && !(view && view->x == 0.3); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (const auto seen = ball.see(none, none)) view = seen;
  }
  REQUIRE(view);
  CHECK(view->y == -0.1);
  CHECK(ball.ignored() == 2);
  CHECK_FALSE(ball.see(none, none));  // the same sighting does not count twice
  std::ofstream(file, std::ios::app) << "\n0.2 0 0\n";
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  CHECK_FALSE(ball.see(none, none));  // an old one does not count
  CHECK_THROWS_WITH_AS(BallReader("/no/such/file"), doctest::Contains("/no/such/file: cannot be read"),
                       example::UsageError);
}

TEST_CASE("joints files: the defaults come back, mistakes are named") {
  const ScratchFolder folder;
  const auto file = folder.path() / "joints.json";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_joints(file);
  };
  CHECK(joints_to_json(read(joints_to_json(default_joints()))) == joints_to_json(default_joints()));
  const auto robot = read(R"({"left_knee": {"id": 40, "sign": -1, "zero_rad": 0.1}})");
  REQUIRE(robot.joints.size() == 12);
  CHECK(robot.joints[3].id == 40);
  CHECK(robot.joints[3].sign == -1);
  CHECK(robot.joints[3].zero_rad == 0.1);
  CHECK_THROWS_WITH_AS(read("[]"), doctest::Contains("no JSON object"), example::UsageError);
  CHECK_THROWS_WITH_AS(read(R"({"tail": {}})"), doctest::Contains("no joint \"tail\""), example::UsageError);
  CHECK_THROWS_WITH_AS(read(R"({"left_knee": {"id": 300}})"), doctest::Contains("left_knee: \"id\" must be 0 to 252"),
                       example::UsageError);
  CHECK_THROWS_WITH_AS(read(R"({"left_knee": {"sign": 0}})"), doctest::Contains("left_knee: \"sign\" must be 1 or -1"),
                       example::UsageError);
  CHECK_THROWS_WITH_AS(read(R"({"left_knee": {"port": 8}})"), doctest::Contains("\"port\" must be 0 to 7"),
                       example::UsageError);
  CHECK_THROWS_WITH_AS(read(R"({"left_knee": {"pose_rad": 1}})"), doctest::Contains("\"pose_rad\" is not known"),
                       example::UsageError);
  CHECK_THROWS_WITH_AS(read(R"({"left_knee": {"max": 2}})"), doctest::Contains("left_knee: \"max\" is not known"),
                       example::UsageError);
}

TEST_CASE("joints files: of neck and arms those that are named, with their poses and ports") {
  const ScratchFolder folder;
  const auto file = folder.path() / "joints.json";
  std::ofstream(file) << joints_to_json(default_joints(true));
  CHECK(joints_to_json(read_joints(file)) == joints_to_json(default_joints(true)));
  CHECK(read_joints(file).joints.size() == 20);
  std::ofstream(file) << R"({"right_elbow": {"id": 30, "port": 2, "pose_rad": -0.7}, "right_knee": {"port": 1}})";
  const RobotJoints robot = read_joints(file);
  REQUIRE(robot.joints.size() == 13);
  CHECK(robot.joints[12].id == 30);
  CHECK(robot.poses_rad == std::vector{-0.7});
  CHECK(robot.ports[12] == 2);
  CHECK(robot.ports[9] == 1);
  CHECK(robot.ports[0] == 0);
}

/// Column names, and all rows as numbers (empty cells: NaN).
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;

  std::vector<double> column(const std::string& name) const {
    const auto k = std::find(names.begin(), names.end(), name) - names.begin();
    std::vector<double> values;
    for (const auto& row : rows) values.push_back(row.at(static_cast<std::size_t>(k)));
    return values;
  }
};

Table read_table(const std::filesystem::path& path) {
  Table table;
  std::ifstream file(path);
  std::string line;
  const auto cells = [](const std::string& text) {
    std::vector<std::string> result(1);
    for (const char c : text) c == ',' ? static_cast<void>(result.emplace_back()) : result.back().push_back(c);
    return result;
  };
  std::getline(file, line);
  table.names = cells(line);
  while (std::getline(file, line)) {
    std::vector<double> row;
    for (const std::string& cell : cells(line)) row.push_back(cell.empty() ? std::nan("") : std::stod(cell));
    table.rows.push_back(row);
  }
  return table;
}

TEST_CASE("a log has a row for every one added, unknown numbers as empty cells") {
  const ScratchFolder folder;
  {
    WalkLog log(folder.path() / "new" / "log.csv");
    LogRow row;
    for (int i = 0; i < 1000; ++i) {
      row.time = 0.01 * i;
      row.positions[2] = i % 2 == 0 ? 0.5 : std::nan("");
      log.add(row);
      if (i % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(log.lost() == 0);
  }
  const Table table = read_table(folder.path() / "new" / "log.csv");
  REQUIRE(table.rows.size() == 1000);
  CHECK(table.column("t_s")[999] == doctest::Approx(9.99));
  CHECK(table.column("position_left_hip_roll_rad")[998] == 0.5);
  CHECK(std::isnan(table.column("position_left_hip_roll_rad")[999]));
  CHECK_THROWS_WITH_AS(WalkLog("/proc/no/log.csv"), doctest::Contains("cannot be written"), example::UsageError);
}

TEST_CASE("surefoot-walk walks on virtual servos, stops by itself and leaves a recording") {
  const ScratchFolder folder;
  const auto log = folder.path() / "walk.csv";
  const auto run = surefoot_walk("run --problem ha --seconds 2 --ball 0.8 0.1 0.2 --log " + log.string());
  CHECK_MESSAGE(run.code == 0, run.output);
  CHECK(run.output.find("lateness of a tick") != std::string::npos);
  const Table table = read_table(log);
  REQUIRE(table.rows.size() > 500);
  CHECK(table.names.size() == table.rows.back().size());
  const auto forward = table.column("order_dx_m"), enabled = table.column("enabled_1");
  CHECK(*std::max_element(forward.begin(), forward.end()) > 0.02);
  CHECK(forward.back() == 0);
  CHECK(enabled.back() == 0);
  double heard = 0, off = 0;  // the servos follow their goals
  const auto goal = table.column("goal_left_knee_rad"), position = table.column("position_left_knee_rad");
  for (std::size_t i = goal.size() / 2; i < goal.size(); ++i) {
    if (std::isnan(position[i])) continue;
    ++heard;
    off += std::abs(goal[i] - position[i]);
  }
  REQUIRE(heard > 200);
  CHECK(off / heard < 0.1);
}

TEST_CASE("surefoot-walk names what is wrong") {
  const auto port = surefoot_walk("run --problem ha --port /dev/no_such_port");
  CHECK(port.code == 2);
  CHECK(port.output.find("/dev/no_such_port") != std::string::npos);
  const auto policy = surefoot_walk("run --problem ha --policy no.policy");
  CHECK(policy.code == 2);
  CHECK(policy.output.find("no.policy") != std::string::npos);
  CHECK(surefoot_walk("joints").output.find("\"left_hip_yaw\"") != std::string::npos);
}

}  // namespace
}  // namespace sigmaban
