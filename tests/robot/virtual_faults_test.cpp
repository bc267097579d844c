// Faults that virtual servos can have, by themselves.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "examples/sigmaban/robot/bus/bus.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"

using namespace dynamixel;

namespace {

constexpr std::uint16_t torque_enable = 64, hardware_error = 70, p_gain = 84, bus_watchdog = 98, goal_position = 116;

struct FaultyLine {
  explicit FaultyLine(AnswererOptions options = {})
      : answerer(two(), options), bus(MemoryTransport<Protocol2>(answerer)) {}

  static std::vector<VirtualServo> two() { return {{mx_64_protocol_2, 1, 0.5}, {mx_64_protocol_2, 2}}; }

  bool write(std::uint16_t address, std::vector<std::uint8_t> bytes) {
    return static_cast<bool>(bus.write(1, address, bytes));
  }
  int byte(std::uint16_t address) {
    std::array<std::uint8_t, 1> byte{};
    return bus.read(1, address, byte) ? byte[0] : -1;
  }
  void wait(double seconds) {
    for (double t = 0; t < seconds; t += 0.01) {
      bus.port().wait(from_seconds(0.01));
      answerer.advance(bus.port().now());
    }
  }

  Answerer<Protocol2> answerer;
  Bus<Protocol2, MemoryTransport<Protocol2>> bus;
};

}  // namespace

TEST_CASE("a servo that starts anew is silent for a while, limp, and has forgotten its gains") {
  FaultyLine line;
  line.wait(0.1);
  CHECK(line.write(p_gain, {100, 0}));
  CHECK(line.write(torque_enable, {1}));
  line.answerer.reboot(1, line.bus.port().now());
  CHECK(line.byte(torque_enable) == -1);
  line.wait(VirtualServo::starts_within_s + 0.1);
  CHECK(line.byte(torque_enable) == 0);
  CHECK(line.byte(p_gain) == (850 & 0xFF));
  CHECK(line.answerer.servo(1).state().position_rad == doctest::Approx(0.5));
}

TEST_CASE("the instruction to reboot does the same") {
  FaultyLine line;
  line.wait(0.1);
  CHECK(line.write(torque_enable, {1}));
  std::array<std::uint8_t, 16> packet{};
  line.answerer.receive(protocol2::reboot(packet, 1), line.bus.port().now());
  line.wait(0.5);
  CHECK(line.byte(torque_enable) == 0);
}

TEST_CASE("a servo that shut itself down says why and takes no torque until it has started anew") {
  FaultyLine line;
  line.wait(0.1);
  CHECK(line.write(torque_enable, {1}));
  line.answerer.servo(1).shut_down(protocol2::overload_error);
  CHECK(line.byte(torque_enable) == 0);
  CHECK(line.bus.statistics(1).last_error_bits == protocol2::alert_bit);
  CHECK(line.byte(hardware_error) == protocol2::overload_error);
  CHECK_FALSE(line.write(torque_enable, {1}));
  line.answerer.reboot(1, line.bus.port().now());
  line.wait(0.5);
  CHECK(line.byte(hardware_error) == 0);
  CHECK(line.write(torque_enable, {1}));
}

TEST_CASE("a bus watchdog trips without instructions, stops the servo where it is, and is cleared by 0") {
  FaultyLine line;
  line.wait(0.1);
  CHECK(line.write(torque_enable, {1}));
  CHECK(line.write(bus_watchdog, {5}));  // 100 ms
  line.wait(0.08);
  CHECK(line.byte(bus_watchdog) == 5);
  line.wait(0.15);
  CHECK(line.answerer.servo(1).watchdog_tripped());
  CHECK(line.byte(bus_watchdog) == 0xFF);
  CHECK(line.byte(torque_enable) == 1);
  CHECK_FALSE(line.write(goal_position, {0, 4, 0, 0}));
  CHECK(line.write(bus_watchdog, {0}));
  CHECK(line.write(goal_position, {0, 4, 0, 0}));
}

TEST_CASE("a bus watchdog does nothing while the torque is off") {
  FaultyLine line;
  line.wait(0.1);
  CHECK(line.write(bus_watchdog, {5}));
  line.wait(0.5);
  CHECK(line.byte(bus_watchdog) == 5);
}

TEST_CASE("a supply that breaks down resets all servos, one that sags is told") {
  FaultyLine line;
  line.wait(0.1);
  CHECK(line.write(torque_enable, {1}));
  line.answerer.set_voltage(9);
  line.wait(0.1);
  CHECK(line.byte(hardware_error) == protocol2::input_voltage_error);
  CHECK(line.byte(torque_enable) == 1);
  line.answerer.set_voltage(5);
  line.wait(0.1);
  CHECK(line.byte(torque_enable) == -1);
  line.answerer.set_voltage(12);
  line.wait(0.5);
  CHECK(line.byte(torque_enable) == 0);
}

TEST_CASE("a Status Return Level of 1 answers questions, one of 0 only pings") {
  FaultyLine line;
  line.answerer.servo(1).set("status_return_level", 1);
  CHECK(line.byte(torque_enable) == 0);
  CHECK_FALSE(line.write(torque_enable, {1}));  // no answer, but done
  CHECK(line.byte(torque_enable) == 1);
  line.answerer.servo(1).set("status_return_level", 0);
  CHECK(line.byte(torque_enable) == -1);
  CHECK(line.bus.ping(1));
}

TEST_CASE("an adapter's latency timer hands answers over late, all at once") {
  FaultyLine line({.latency_timer_s = 0.016});
  line.bus.set_patience(0, 0.05);
  CHECK(line.bus.ping(1));
  CHECK(line.bus.port().now() % std::chrono::milliseconds(16) == Time::zero());
}

TEST_CASE("a servo whose cable is cut hears nothing, and swapped ids move the other joint") {
  FaultyLine line;
  line.answerer.servo(2).deaf = true;
  CHECK_FALSE(line.bus.ping(2));
  line.answerer.servo(2).deaf = false;
  line.answerer.swap_ids(1, 2);
  line.wait(0.1);
  std::array<std::uint8_t, 2> bytes{};
  REQUIRE(line.bus.read(2, 132, bytes));
  CHECK(radians_from_ticks(bytes[0] + 256 * bytes[1]) == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("instructions that are not heard have no effect") {
  FaultyLine line({.faults = {.unheard = 1}});
  CHECK_FALSE(line.bus.ping(1));
  CHECK(line.answerer.instructions() > 0);
}

TEST_CASE("a port that is gone says so, to whoever reads or writes") {
  FaultyLine line;
  line.bus.port().hang_up();
  CHECK_THROWS_AS(static_cast<void>(line.bus.ping(1)), BusError);
}
