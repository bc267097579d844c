// Lines that are slow: servos as they come from the factory, many of them, a slow bus; and what is still read.
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/servos/servo_group.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"

using namespace dynamixel;

namespace {

struct SlowLine {
  int servos = 20;
  double return_delay_s = 0;
  std::uint32_t bits_per_s = 3'000'000;
};

struct Read {
  double per_cycle = 0;     // answers
  double slowest_s = 0;     // cycle
  bool health_too = false;  // in each cycle
  double voltage_v = 0;     // of the last joint
};

/// Two seconds at 100 Hz, with an adapter and an operating system that take no time.
Read read(const SlowLine& slow) {
  std::vector<VirtualServo> servos;
  std::vector<Joint> joints;
  for (int i = 1; i <= slow.servos; ++i) {
    const auto id = static_cast<std::uint8_t>(i);
    servos.emplace_back(mx_64_protocol_2, id);
    servos.back().set("return_delay_time", static_cast<std::int64_t>(slow.return_delay_s / return_delay_s));
    joints.push_back({.name = std::to_string(i), .id = id});
  }
  using Line = Bus<Protocol2, MemoryTransport<Protocol2>>;
  Answerer<Protocol2> answerer(servos, {.bits_per_s = slow.bits_per_s});
  Line bus(MemoryTransport<Protocol2>(answerer), {.return_delay_s = 0, .latency_s = 200e-6});
  ServoGroup<Line> group(bus, mx_64_protocol_2, joints, {.listen_s = 0.0075});
  group.start();
  Read result;
  const std::vector<double> goals(joints.size(), 0.1);
  std::size_t answers = 0;
  constexpr int cycles = 200;
  Time due = group.now();
  for (int i = 0; i < cycles; ++i, due += from_seconds(0.01)) {
    group.wait_until(due);
    const Time begin = group.now();
    group.set_goals(goals);
    answers += group.update();
    result.slowest_s = std::max(result.slowest_s, to_seconds(group.now() - begin));
  }
  CHECK(group.torque_on());
  CHECK_FALSE(group.fault());
  result.per_cycle = static_cast<double>(answers) / cycles;
  result.health_too = group.feedback().count() > 8;
  result.voltage_v = group.states().back().voltage_v;
  return result;
}

}  // namespace

TEST_CASE("twelve new servos, whose answers begin after 500 us, are all read at 100 Hz") {
  const Read result = read({.servos = 12, .return_delay_s = 500e-6});
  CHECK(result.per_cycle == 12);
  CHECK(result.slowest_s < 0.01);
  CHECK(result.voltage_v == doctest::Approx(12));
}

TEST_CASE("twenty servos are all read after 250 us, at 1 Mbit/s after none, health in turn") {
  for (const SlowLine& slow : {SlowLine{.return_delay_s = 250e-6}, SlowLine{.bits_per_s = 1'000'000}}) {
    const Read result = read(slow);
    CAPTURE(slow.bits_per_s);
    CHECK(result.per_cycle == 20);
    CHECK(result.slowest_s < 0.01);
    CHECK_FALSE(result.health_too);
    CHECK(result.voltage_v == doctest::Approx(12));
  }
}

TEST_CASE("twenty servos at 3 Mbit/s without delay tell their health in each cycle") {
  const Read result = read({});
  CHECK(result.per_cycle == 20);
  CHECK(result.health_too);
}

TEST_CASE("twenty new servos are read as far as a cycle has time, the others in the next") {
  const Read result = read({.return_delay_s = 500e-6});
  CHECK(result.per_cycle > 9);
  CHECK(result.slowest_s < 0.011);
}
