// The safety layer: limits, soft start, watchdog, alarms, silence.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/servos/servo_group.hpp"
#include "tests/examples/robot_bus_line.hpp"

using namespace dynamixel;

namespace {

using Line = TestLine<Protocol2>;
using Group = ServoGroup<Bus<Protocol2, MemoryTransport<Protocol2>>>;

std::vector<Joint> joints(int count) {
  std::vector<Joint> made;
  for (int i = 1; i <= count; ++i) {
    made.push_back(
        {.name = "joint " + std::to_string(i), .id = static_cast<std::uint8_t>(i), .min_rad = -1, .max_rad = 1});
  }
  return made;
}

bool torque_of(Line& line, std::uint8_t id) {
  std::array<std::uint8_t, 1> byte{};
  CHECK(line.answerer.servo(id).read(64, byte) == Refusal::none);
  return byte[0] != 0;
}

double goal_of(Line& line, std::uint8_t id) {
  std::array<std::uint8_t, 2> bytes{};
  CHECK(line.answerer.servo(id).read(116, bytes) == Refusal::none);
  return radians_from_ticks(bytes[0] + 256 * bytes[1]);
}

/// `cycles` of 10 ms with the same goal for all; `each` is called behind each.
template <class Each>
void walk(Line& line, Group& group, double goal, int cycles, Each each) {
  const std::vector<double> goals(group.joints().size(), goal);
  for (int i = 0; i < cycles; ++i) {
    const Time start = line.bus.port().now();
    group.set_goals(goals);
    group.update();
    each();
    line.bus.port().wait(start + from_seconds(0.01) - line.bus.port().now());
  }
}
void walk(Line& line, Group& group, double goal, int cycles) {
  walk(line, group, goal, cycles, [] {});
}

std::optional<ServoEvent> event_of(const Group& group, ServoEventKind kind) {
  for (const ServoEvent& event : group.events()) {
    if (event.kind == kind) return event;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("joints that make no sense are told by name") {
  Line line(3);
  const auto refused = [&](auto change) {
    std::vector<Joint> wrong = joints(3);
    change(wrong);
    CHECK_THROWS_AS(Group(line.bus, mx_64_protocol_2, wrong), BusError);
  };
  refused([](auto& all) { all.clear(); });
  refused([](auto& all) { all[1].id = 1; });
  refused([](auto& all) { all[1].name = all[0].name; });
  refused([](auto& all) { all[2].sign = 0; });
  refused([](auto& all) { all[2].min_rad = 2; });
  refused([](auto& all) { all[2].zero_rad = 3; });  // its upper limit is beyond the servo's turn
}

TEST_CASE("zero and sign lie between a joint and its servo") {
  Line line(1);
  Group group(line.bus, mx_64_protocol_2,
              {{.name = "knee", .id = 1, .zero_rad = 0.4, .sign = -1, .min_rad = -1, .max_rad = 1}},
              {.soft_start_s = 0});
  group.start();
  CHECK(group.states()[0].position_rad == doctest::Approx(0.35).epsilon(0.01));  // the servo is at 0.05
  walk(line, group, -0.2, 200);
  CHECK(line.answerer.servo(1).state().position_rad == doctest::Approx(0.6).epsilon(0.02));
  CHECK(group.states()[0].position_rad == doctest::Approx(-0.2).epsilon(0.05));
  CHECK(group.states()[0].voltage_v == doctest::Approx(12));
  CHECK(group.states()[0].temperature_celsius == doctest::Approx(35));
  CHECK(line.bus.statistics(1).highest_celsius == doctest::Approx(35));
}

TEST_CASE("goals beyond the limits are clamped or refused, and counted") {
  for (const BeyondLimits rule : {BeyondLimits::clamp, BeyondLimits::refuse}) {
    Line line(2);
    Group group(line.bus, mx_64_protocol_2, joints(2), {.soft_start_s = 0, .beyond_limits = rule});
    group.start();
    CHECK(group.set_goals(std::array{0.3, 0.3}));
    CHECK(group.set_goals(std::array{1.7, -0.5}));
    group.update();
    CHECK(goal_of(line, 1) == doctest::Approx(rule == BeyondLimits::clamp ? 1.0 : 0.3).epsilon(0.01));
    CHECK(goal_of(line, 2) == doctest::Approx(-0.5).epsilon(0.01));
    CHECK(group.states()[0].goals_beyond_limits == 1);
    CHECK(group.states()[1].goals_beyond_limits == 0);
    CHECK_FALSE(group.set_goals(std::array{0.0, std::numeric_limits<double>::quiet_NaN()}));
    CHECK_FALSE(group.set_goals(std::array{0.0}));
    CHECK(group.refused_goals() == 2);
    group.update();
    CHECK(goal_of(line, 2) == doctest::Approx(-0.5).epsilon(0.01));
  }
}

TEST_CASE("torque goes on where the joints are, and goals take over softly") {
  Line line(2);
  Group group(line.bus, mx_64_protocol_2, joints(2), {.soft_start_s = 1});
  CHECK_FALSE(torque_of(line, 1));
  group.start();
  CHECK(torque_of(line, 1));
  CHECK(torque_of(line, 2));
  CHECK(goal_of(line, 2) == doctest::Approx(0.1).epsilon(0.02));
  double last = goal_of(line, 2), largest = 0;
  walk(line, group, -0.9, 110, [&] {
    largest = std::max(largest, std::abs(goal_of(line, 2) - last));
    last = goal_of(line, 2);
  });
  CHECK(largest < 0.018);  // 1.5 rad/s at most, for 1 rad within 1 s
  CHECK(last == doctest::Approx(-0.9).epsilon(0.01));
}

TEST_CASE("a joint found beyond its limits is brought back softly, not at once") {
  Line line(1);
  std::vector<Joint> one = joints(1);
  one[0].min_rad = 0.5;
  Group group(line.bus, mx_64_protocol_2, one, {.soft_start_s = 1});
  group.start();
  walk(line, group, 0.0, 1);
  CHECK(goal_of(line, 1) < 0.1);
  walk(line, group, 0.0, 110);
  CHECK(goal_of(line, 1) == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("without goals the torque goes off, and stays off until the next start") {
  Line line(3);
  Group group(line.bus, mx_64_protocol_2, joints(3), {.watchdog_s = 0.1});
  group.start();
  walk(line, group, 0, 20);
  CHECK(group.torque_on());
  int cycles = 0;
  while (group.torque_on() && cycles < 100) {
    group.update();
    line.bus.port().wait(from_seconds(0.005));
    ++cycles;
  }
  CHECK(event_of(group, ServoEventKind::watchdog));
  for (const std::uint8_t id : line.ids) CHECK_FALSE(torque_of(line, id));
  walk(line, group, 0, 5);
  CHECK_FALSE(torque_of(line, 1));
  group.start();
  CHECK(torque_of(line, 1));
}

TEST_CASE("the torque goes off at the end and with any exception") {
  Line line(3);
  {
    Group group(line.bus, mx_64_protocol_2, joints(3));
    group.start();
    CHECK(torque_of(line, 3));
  }
  CHECK_FALSE(torque_of(line, 3));
  try {
    Group group(line.bus, mx_64_protocol_2, joints(3));
    group.start();
    throw std::runtime_error("the walk stumbles");
  } catch (const std::runtime_error& error) {
    CHECK(std::string(error.what()) == "the walk stumbles");
  }
  CHECK_FALSE(torque_of(line, 3));
}

TEST_CASE("a start without one of the servos fails by its name, torque off") {
  Line line(3);
  line.answerer.set_silent(2, true);
  Group group(line.bus, mx_64_protocol_2, joints(3));
  CHECK_THROWS_WITH_AS(group.start(), "joint joint 2 (servo 2): does not answer; check its id, its cable and the power",
                       BusError);
  for (const std::uint8_t id : line.ids) CHECK_FALSE(torque_of(line, id));
}

TEST_CASE("a servo that falls silent is reported within 50 ms, once, and again when it is back") {
  Line line(20, {.faults = {.lost = 0.01, .corrupted = 0.01}, .seed = 9});
  Group group(line.bus, mx_64_protocol_2, joints(20), {.soft_start_s = 0});
  group.start();
  int reports = 0, backs = 0;
  std::optional<Time> reported;
  const auto look = [&] {
    if (const auto event = event_of(group, ServoEventKind::silent)) {
      ++reports;
      reported = line.bus.port().now();
      CHECK(event->joint == 4);
    }
    if (event_of(group, ServoEventKind::back)) ++backs;
  };
  walk(line, group, 0.1, 300, look);
  CHECK(reports == 0);
  const Time begin = line.bus.port().now();
  line.answerer.set_silent(5, true);
  walk(line, group, 0.1, 200, look);
  CHECK(reports == 1);
  CHECK(backs == 0);
  CHECK(group.states()[4].silent);
  CHECK(reported.value_or(Time::max()) - begin <= from_seconds(0.050));
  line.answerer.set_silent(5, false);
  walk(line, group, 0.1, 5, look);
  CHECK(backs == 1);
  CHECK_FALSE(group.states()[4].silent);
}

TEST_CASE("heat and a sagging voltage raise alarms, without flicker") {
  Line line(2);
  Group group(line.bus, mx_64_protocol_2, joints(2));
  group.start();
  const auto after = [&](double celsius, double volts) {
    line.answerer.servo(2).temperature_celsius = celsius;
    line.answerer.set_voltage(volts);
    walk(line, group, 0, 2);
    walk(line, group, 0, 1);
    return group.states()[1].alarms;
  };
  CHECK(after(50, 12) == Alarms{});
  CHECK(after(66, 12) == Alarms{.hot = true});
  CHECK(after(63, 10) == Alarms{.hot = true, .voltage = true});
  CHECK(after(55, 10.6) == Alarms{.voltage = true});
  CHECK(after(55, 11) == Alarms{});
  CHECK(line.bus.statistics(2).highest_celsius == doctest::Approx(66));
  CHECK(line.bus.statistics(2).lowest_v == doctest::Approx(10));
}

TEST_CASE("a group works with Protocol 1.0, and with motion alone in each cycle") {
  TestLine<Protocol1> line(4, {.bits_per_s = 1'000'000, .faults = {.lost = 0.01}});
  ServoGroup<Bus<Protocol1, MemoryTransport<Protocol1>>> group(line.bus, mx_64_protocol_1, joints(4),
                                                               {.soft_start_s = 0, .feedback = FeedbackKind::motion});
  group.start();
  const std::array goals{0.1, -0.1, 0.2, -0.2};
  for (int i = 0; i < 100; ++i) {
    group.set_goals(goals);
    group.update();
    line.bus.port().wait(from_seconds(0.005));
  }
  for (std::size_t i = 0; i < 4; ++i) CHECK(group.states()[i].position_rad == doctest::Approx(goals[i]).epsilon(0.05));
  CHECK(group.states()[0].voltage_v == doctest::Approx(12));  // asked for in turn
}
