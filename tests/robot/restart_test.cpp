// Starts after programs that did not end as they should.
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/servos/servo_group.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"

using namespace dynamixel;

namespace {

using RestartLine = Bus<Protocol2, MemoryTransport<Protocol2>>;

std::vector<VirtualServo> three_servos() {
  return {{mx_64_protocol_2, 1, 0.1}, {mx_64_protocol_2, 2, 0.2}, {mx_64_protocol_2, 3, 0.3}};
}

std::vector<Joint> three_joints() {
  return {{.name = "hip", .id = 1}, {.name = "knee", .id = 2}, {.name = "ankle", .id = 3}};
}

void run_cycles(RestartLine& bus, ServoGroup<RestartLine>& group, int count) {
  for (int i = 0; i < count; ++i) {
    group.set_goals(std::array{0.0, 0.0, 0.0});
    group.update();
    bus.port().wait(from_seconds(0.01));
  }
}

}  // namespace

TEST_CASE("servos that their bus watchdogs stopped are started again, though instructions are lost") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Answerer<Protocol2> answerer(three_servos(), {.faults = {.lost = 0.05, .unheard = 0.05}, .seed = seed});
    RestartLine bus(MemoryTransport<Protocol2>(answerer), {.return_delay_s = 0, .latency_s = 200e-6});
    for (std::uint8_t id = 1; id <= 3; ++id) {
      answerer.servo(id).set("torque_enable", 1);
      answerer.servo(id).set("bus_watchdog", 0xFF);
    }
    {
      ServoGroup<RestartLine> group(bus, mx_64_protocol_2, three_joints(), {.soft_start_s = 0.1});
      group.start();
      for (const VirtualServo& servo : answerer.servos()) {
        CHECK(servo.torque_on());
        CHECK_FALSE(servo.watchdog_tripped());
      }
      run_cycles(bus, group, 50);
      CHECK(group.torque_on());
      CHECK(answerer.servo(3).state().position_rad == doctest::Approx(0).epsilon(0.02));
    }
    for (const VirtualServo& servo : answerer.servos()) CHECK_FALSE(servo.torque_on());
  }
}

TEST_CASE("a group that let go can be started again, and a walk that keeps its torque leaves no watchdog behind") {
  Answerer<Protocol2> answerer(three_servos());
  RestartLine bus(MemoryTransport<Protocol2>(answerer), {.return_delay_s = 0, .latency_s = 200e-6});
  ServoGroup<RestartLine> group(bus, mx_64_protocol_2, three_joints(), {.soft_start_s = 0.1});
  group.start();
  run_cycles(bus, group, 10);
  group.let_go();
  CHECK(group.unconfirmed() == 0);
  run_cycles(bus, group, 10);
  CHECK_FALSE(answerer.servo(1).torque_on());
  group.start();
  run_cycles(bus, group, 10);
  group.keep_torque();
  for (int i = 0; i < 200; ++i) {
    bus.port().wait(from_seconds(0.01));
    answerer.advance(bus.port().now());
  }
  CHECK(answerer.servo(1).torque_on());
  CHECK_FALSE(answerer.servo(1).watchdog_tripped());
}
