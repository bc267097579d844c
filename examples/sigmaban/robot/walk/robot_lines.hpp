// The serial lines of a robot, real or simulated: bus, torque guard and servos of each, and all of them as one group.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../../../apps/common/usage_error.hpp"
#include "../bus/background_port.hpp"
#include "../bus/serial_port.hpp"
#include "../servos/joint_lines.hpp"
#include "../servos/torque_guard.hpp"
#include "../setup/line_model.hpp"
#include "../virtual_bus/virtual_bus.hpp"
#include "joints_file.hpp"
#include "sitting_pose.hpp"
#include "walk_run.hpp"

namespace sigmaban {

/// Joints of one port, as a walk drives them. `places` are theirs among all joints of the robot.
inline dynamixel::ServoGroupOptions line_options(const WalkRun& options, const RobotJoints& robot,
                                                 const std::vector<std::size_t>& places, double rise_s) {
  dynamixel::ServoGroupOptions group;
  group.soft_start_s = rise_s - 0.5;  // the robot stands before it steps
  group.listen_s = 0.75 / options.rate_hz;
  group.care.poll_s = 0.2 / options.rate_hz;
  group.bus_watchdog_s = options.bus_watchdog_s;
  const auto legs = sitting_pose(options.walk);
  if (!legs) return group;
  const auto angles = legs->array();
  for (const std::size_t i : places) {
    group.sitting_rad.push_back(i < angles.size() ? angles[i] : robot.poses_rad[i - angles.size()]);
  }
  return group;
}

template <class Protocol>
class RobotLines {
 public:
  using Bus = dynamixel::Bus<Protocol, dynamixel::BackgroundPort<dynamixel::SerialPort>>;
  using Group = dynamixel::ServoGroup<Bus>;

  /// Opens the ports. Throws UsageError where ports and joints do not fit, BusError where a port cannot be opened.
  RobotLines(const WalkRun& options, const RobotJoints& robot, double rise_s) {
    const std::vector<std::string> ports = ports_of(options, robot);
    std::vector<Group*> groups;
    for (std::size_t port = 0; port < ports.size(); ++port) {
      lines_.push_back(std::make_unique<Line>(ports[port], options, robot, port, rise_s));
      groups.push_back(&lines_.back()->group);
    }
    all_.emplace(groups, robot.ports);
  }

  dynamixel::JointLines<Group>& group() { return *all_; }
  /// The bus of the first port.
  Bus& bus() { return lines_.front()->bus; }

  /// For people.
  std::string names() const {
    std::string text;
    for (const auto& line : lines_) text += (text.empty() ? "" : ", ") + line->name;
    return text;
  }

  /// Of all servos.
  dynamixel::ServoStatistics statistics() const {
    dynamixel::ServoStatistics sum;
    for (const auto& line : lines_) {
      for (const dynamixel::Joint& joint : line->group.joints()) sum += line->bus.statistics(joint.id);
    }
    return sum;
  }

 private:
  struct Line {
    Line(const std::string& port, const WalkRun& options, const RobotJoints& robot, std::size_t number, double rise_s)
        : places(places_of(robot, number)),
          simulated(simulation(port, options, joints_at(robot, places), number)),
          name(simulated ? "virtual bus " + simulated->path() : port),
          bus(dynamixel::BackgroundPort(
                  dynamixel::SerialPort(simulated ? simulated->path() : port, options.bits_per_s)),
              {.return_delay_s = simulated ? 0 : 500e-6,
               .latency_s = 1.5e-3,
               .fast_sync_read = options.fast_sync_read}),
          guard(simulated
                    ? nullptr
                    : new dynamixel::TorqueGuard(bus.port().port().file(), {.name = "surefoot-walk: torque guard"})),
          model(dynamixel::line_model(bus, joints_at(robot, places), usual)),
          group(bus, *model.model, joints_at(robot, places), group_options(options, robot, rise_s)) {}

    dynamixel::ServoGroupOptions group_options(const WalkRun& options, const RobotJoints& robot, double rise_s) const {
      dynamixel::ServoGroupOptions made = line_options(options, robot, places, rise_s);
      made.alarms = model.alarms;
      made.feedback = model.feedback;
      made.guard = guard.get();  // none for virtual servos, which end with this program
      if (simulated) made.watchdog_s = made.care.group.line_is_dead_s = 1;  // a machine that simulates may stand still
      return made;
    }

    std::vector<std::size_t> places;
    std::unique_ptr<dynamixel::VirtualBus<Protocol>> simulated;
    std::string name;
    Bus bus;
    std::unique_ptr<dynamixel::TorqueGuard> guard;
    dynamixel::LineModel model;
    Group group;
  };

  static constexpr const dynamixel::ServoModel& usual =
      Protocol::version == 1 ? dynamixel::mx_64_protocol_1 : dynamixel::mx_64_protocol_2;

  /// One for each port that the joints name; a single virtual one stands for as many as there are.
  static std::vector<std::string> ports_of(const WalkRun& options, const RobotJoints& robot) {
    const std::size_t wanted = *std::ranges::max_element(robot.ports) + 1;
    std::vector<std::string> ports = options.ports;
    if (ports == std::vector<std::string>{"virtual"}) ports.resize(wanted, "virtual");
    const auto fail = [](const std::string& what) { throw example::UsageError("--port: " + what); };
    if (ports.size() < wanted) {
      fail("the joints are on " + std::to_string(wanted) + " ports, give as many, with commas between them");
    }
    for (std::size_t port = 0; port < ports.size(); ++port) {
      if (std::ranges::count(robot.ports, port) == 0) {
        fail(ports[port] + " moves no joint; say in the file of --joints which ones are on port " +
             std::to_string(port));
      }
    }
    return ports;
  }

  static std::vector<std::size_t> places_of(const RobotJoints& robot, std::size_t port) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < robot.ports.size(); ++i) {
      if (robot.ports[i] == port) places.push_back(i);
    }
    return places;
  }

  static std::vector<dynamixel::Joint> joints_at(const RobotJoints& robot, const std::vector<std::size_t>& places) {
    std::vector<dynamixel::Joint> joints;
    for (const std::size_t i : places) joints.push_back(robot.joints[i]);
    dynamixel::check_joints(joints, joints.size());
    return joints;
  }

  static std::unique_ptr<dynamixel::VirtualBus<Protocol>> simulation(const std::string& port, const WalkRun& options,
                                                                     const std::vector<dynamixel::Joint>& joints,
                                                                     std::size_t number) {
    if (port != "virtual") return nullptr;
    std::vector<dynamixel::VirtualServo> servos;
    for (const dynamixel::Joint& joint : joints) {
      servos.emplace_back(usual, joint.id, dynamixel::servo_angle(joint, 0));
    }
    return std::make_unique<dynamixel::VirtualBus<Protocol>>(
        dynamixel::Answerer<Protocol>(servos, {.bits_per_s = options.bits_per_s, .seed = options.seed + number}));
  }

  std::vector<std::unique_ptr<Line>> lines_;
  std::optional<dynamixel::JointLines<Group>> all_;
};

}  // namespace sigmaban
