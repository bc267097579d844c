// The servos of a robot on several lines, in virtual time: 20 joints on three ports.
#include "examples/sigmaban/robot/servos/joint_lines.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"

using namespace dynamixel;

namespace {

using Port = MemoryTransport<Protocol2>;
using Line = Bus<Protocol2, Port>;
using Group = ServoGroup<Line>;

constexpr std::size_t ports = 3, joints = 20;

/// Servos with the ids 1 to 7 or so behind each port: joint i is on port i % 3.
struct RobotOnPorts {
  RobotOnPorts() {
    std::vector<Group*> groups;
    for (std::size_t port = 0; port < ports; ++port) {
      std::vector<VirtualServo> servos;
      std::vector<Joint> made;
      for (std::size_t i = port; i < joints; i += ports) {
        const auto id = static_cast<std::uint8_t>(made.size() + 1);
        servos.emplace_back(mx_64_protocol_2, id, 0.02 * static_cast<double>(i));
        made.push_back({.name = "joint " + std::to_string(i), .id = id});
      }
      answerers.push_back(std::make_unique<Answerer<Protocol2>>(servos, AnswererOptions{.seed = port}));
      buses.push_back(std::make_unique<Line>(Port(*answerers.back()), BusOptions{.return_delay_s = 0}));
      owned.push_back(std::make_unique<Group>(
          *buses.back(), mx_64_protocol_2, made,
          ServoGroupOptions{.soft_start_s = 0.1, .sitting_rad = std::vector<double>(made.size(), 0.3), .sit_s = 0.1}));
      groups.push_back(owned.back().get());
    }
    for (std::size_t i = 0; i < joints; ++i) line_of.push_back(i % ports);
    all = std::make_unique<JointLines<Group>>(groups, line_of);
  }

  std::vector<double> goals() const {
    std::vector<double> made;
    for (std::size_t i = 0; i < joints; ++i) made.push_back(0.1 + 0.03 * static_cast<double>(i));
    return made;
  }

  /// Cycles of 10 ms. Returns the events.
  std::vector<ServoEvent> run(int cycles) {
    std::vector<ServoEvent> events;
    for (int cycle = 0; cycle < cycles; ++cycle) {
      all->set_goals(goals());
      all->update();
      events.insert(events.end(), all->events().begin(), all->events().end());
      const Time next = all->now() + from_seconds(0.01);
      all->wait_until(next);
      for (auto& answerer : answerers) answerer->advance(next);
    }
    return events;
  }

  std::size_t torques() const {
    std::size_t on = 0;
    for (const auto& answerer : answerers) {
      for (const VirtualServo& servo : answerer->servos()) on += servo.torque_on() ? 1U : 0U;
    }
    return on;
  }
  VirtualServo& servo(std::size_t joint) {
    return answerers[joint % ports]->servo(static_cast<std::uint8_t>(joint / ports + 1));
  }

  std::vector<std::unique_ptr<Answerer<Protocol2>>> answerers;
  std::vector<std::unique_ptr<Line>> buses;
  std::vector<std::unique_ptr<Group>> owned;
  std::vector<std::size_t> line_of;
  std::unique_ptr<JointLines<Group>> all;
};

}  // namespace

TEST_CASE("twenty joints on three lines get their goals and are read, each its own") {
  RobotOnPorts robot;
  robot.all->start();
  CHECK(robot.torques() == joints);
  CHECK(robot.run(100).empty());
  for (std::size_t i = 0; i < joints; ++i) {
    CHECK(robot.all->states()[i].fresh);
    CHECK(robot.all->states()[i].position_rad == doctest::Approx(robot.goals()[i]).epsilon(0.03));
    CHECK(robot.servo(i).state().position_rad == doctest::Approx(robot.goals()[i]).epsilon(0.03));
    CHECK(robot.all->sent_goal(i) == doctest::Approx(robot.goals()[i]).epsilon(0.01));
  }
  std::vector<double> few(joints - 1, 0);
  CHECK_FALSE(robot.all->set_goals(few));
  few.push_back(std::nan(""));
  CHECK_FALSE(robot.all->set_goals(few));
}

TEST_CASE("one line that sits down or lets go takes the others along, and says whose fault it was") {
  const auto after = [](const std::function<void(RobotOnPorts&)>& fault) {
    RobotOnPorts robot;
    robot.all->start();
    robot.run(30);
    fault(robot);
    const auto events = robot.run(150);
    CHECK(robot.torques() == 0);
    CHECK_FALSE(robot.all->torque_on());
    CHECK(std::ranges::count(events, ServoEventKind::let_go, &ServoEvent::kind) >= 1);
    return robot.all->fault();
  };
  const auto overload = after([](RobotOnPorts& robot) { robot.servo(7).shut_down(protocol2::overload_error); });
  REQUIRE(overload);
  CHECK(overload->joint == 7);
  const auto torn = after([](RobotOnPorts& robot) {  // its line goes silent altogether, but hears
    for (std::size_t i = 2; i < joints; i += ports) robot.answerers[2]->set_silent(robot.servo(i).id(), true);
  });
  REQUIRE(torn);
  CHECK(torn->joint % ports == 2);
}

TEST_CASE("lines that cannot all start leave no torque on") {
  RobotOnPorts robot;
  robot.servo(19).temperature_celsius = 90;
  CHECK_THROWS_WITH_AS(robot.all->start(), doctest::Contains("joint 19"), BusError);
  CHECK(robot.torques() == 0);
}

TEST_CASE("a port that goes away ends the others too") {
  RobotOnPorts robot;
  robot.all->start();
  robot.run(10);
  robot.buses[1]->port().hang_up();
  CHECK_THROWS_AS(robot.run(5), BusError);
  for (std::size_t i = 0; i < joints; ++i) {
    if (i % ports != 1) CHECK_FALSE(robot.servo(i).torque_on());
  }
}
