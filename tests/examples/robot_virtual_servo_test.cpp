// The simulated servo: its motor, its registers, and servos as bytes in, bytes out.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/virtual_bus/answerer.hpp"
#include "tests/examples/robot_dynamixel_hex.hpp"

using namespace dynamixel;

namespace {

MotorState run(MotorState state, const MotorInputs& inputs, double seconds, double dt = 1e-3) {
  for (double t = 0; t < seconds; t += dt) state = step(MotorParameters{}, state, inputs, dt);
  return state;
}

/// All that a line answers to an instruction, as in a manual.
template <class Protocol>
std::string answers(Answerer<Protocol>& line, const std::string& instruction, Time now = {}) {
  line.receive(bytes_of(instruction), now);
  std::array<std::uint8_t, 300> out;
  std::string all;
  while (const auto due = line.next_due()) {
    const std::size_t size = line.take(*due, out);
    all += (all.empty() ? "" : " | ") + hex_of(Bytes(out).first(size));
  }
  return all;
}

std::vector<VirtualServo> two(const ServoModel& model) { return {VirtualServo(model, 1), VirtualServo(model, 2)}; }

}  // namespace

TEST_CASE("a motor goes to its goal and stays short of it by no more than friction allows") {
  const MotorParameters motor;
  const MotorState end = run({}, {.torque_on = true, .goal_rad = 0.5}, 3);
  CHECK(std::abs(end.position_rad - 0.5) <= motor.dry_friction / motor.stiffness + 1e-12);
  CHECK(end.velocity_rad_per_s == 0);  // it sticks
}

TEST_CASE("a load turns a driven motor by load over stiffness, which the voltage scales") {
  for (const double volts : {12.0, 9.0}) {
    const MotorState end = run({}, {.torque_on = true, .voltage_v = volts, .load_nm = 1.0}, 5);
    const double stiffness = 24.0 * volts / 12.0;
    CHECK(std::abs(end.position_rad - 1.0 / stiffness) <= 0.09 / stiffness + 1e-9);
  }
}

TEST_CASE("dry friction holds a shaft against a smaller torque, exactly") {
  const MotorState held = run({}, {.load_nm = 0.089}, 2);
  CHECK(held.position_rad == 0);
  CHECK(run({}, {.load_nm = 0.1}, 2).position_rad > 0);
}

TEST_CASE("a driver at full voltage ends at the speed where back-EMF and friction take all of it") {
  const MotorParameters motor;
  MotorState state;
  for (int i = 0; i < 2000; ++i)
    state = step(motor, state, {.torque_on = true, .goal_rad = state.position_rad + 3}, 1e-3);
  const double full_torque = motor.torque_constant / motor.resistance_ohm * 12;
  CHECK(state.velocity_rad_per_s == doctest::Approx((full_torque - motor.dry_friction) / motor.damping).epsilon(1e-6));
}

TEST_CASE("half the step hardly changes the path") {
  const MotorInputs inputs{.torque_on = true, .goal_rad = 0.8, .load_nm = 0.3};
  for (const double seconds : {0.05, 0.1, 0.4}) {
    CHECK(run({}, inputs, seconds, 1e-3).position_rad ==
          doctest::Approx(run({}, inputs, seconds, 0.5e-3).position_rad).epsilon(0.02));
  }
}

TEST_CASE("a servo of every model goes to its goal and says that it is there, in its own ticks") {
  for (const ServoModel& model : servo_models) {
    CAPTURE(model.name);
    VirtualServo servo(model, 1);
    const Register& goal = *model.find("goal_position");
    const int ticks = model.center + static_cast<int>(0.5 / model.tick_rad);
    std::array<std::uint8_t, 4> bytes{static_cast<std::uint8_t>(ticks), static_cast<std::uint8_t>(ticks >> 8)};
    CHECK(servo.write(goal.address, Bytes(bytes).first(goal.size)) == Refusal::none);
    servo.set("torque_enable", 1);
    for (int i = 0; i < 300; ++i) servo.advance(from_seconds(0.01 * i));
    CHECK(servo.state().position_rad == doctest::Approx(0.5).epsilon(0.05));
    const Register& present = *model.find("present_position");
    CHECK(servo.read(present.address, Buffer(bytes).first(present.size)) == Refusal::none);
    CHECK(std::abs(bytes[0] + 256 * bytes[1] - ticks) <= 0.025 / model.tick_rad);
  }
}

TEST_CASE("registers show what the motor does") {
  VirtualServo servo(mx_64_protocol_2, 7, 0.5);
  std::array<std::uint8_t, 4> bytes{};
  const auto position = [&] {
    CHECK(servo.read(132, bytes) == Refusal::none);
    return bytes[0] + 256 * bytes[1];
  };
  servo.advance(from_seconds(0));
  CHECK(position() == 2048 + 326);
  const std::array<std::uint8_t, 4> goal{0x00, 0x08, 0, 0};
  CHECK(servo.write(116, goal) == Refusal::none);
  servo.advance(from_seconds(0.5));
  CHECK(position() == 2048 + 326);  // the torque is off
  const std::uint8_t on = 1;
  CHECK(servo.write(64, Bytes(&on, 1)) == Refusal::none);
  for (int i = 0; i < 100; ++i) servo.advance(from_seconds(0.5 + 0.01 * i));
  CHECK(std::abs(position() - 2048) <= 3);
}

TEST_CASE("servos refuse what the e-Manual says they do") {
  VirtualServo servo(mx_64_protocol_2, 1);
  const std::array<std::uint8_t, 4> far{0x00, 0x20, 0, 0};
  const std::uint8_t one = 1;
  CHECK(servo.write(116, far) == Refusal::limit);          // beyond 4095
  CHECK(servo.write(132, Bytes(far)) == Refusal::access);  // read only
  CHECK(servo.write(7, Bytes(&one, 1)) == Refusal::none);  // the id, torque off
  CHECK(servo.write(64, Bytes(&one, 1)) == Refusal::none);
  CHECK(servo.write(7, Bytes(&one, 1)) == Refusal::access);  // torque on
  CHECK(servo.write(2000, Bytes(&one, 1)) == Refusal::range);
}

TEST_CASE("an overheated servo lets go and says so") {
  VirtualServo servo(mx_64_protocol_2, 1);
  const std::uint8_t one = 1;
  CHECK(servo.write(64, Bytes(&one, 1)) == Refusal::none);
  servo.temperature_celsius = 85;
  servo.advance(from_seconds(0.1));
  std::array<std::uint8_t, 1> byte{};
  CHECK(servo.read(64, byte) == Refusal::none);
  CHECK(byte[0] == 0);
  CHECK(servo.error_bits(Refusal::none) == protocol2::alert_bit);
  CHECK(servo.read(70, byte) == Refusal::none);
  CHECK(byte[0] == protocol2::overheating_error);
  servo.temperature_celsius = 40;
  servo.voltage_v = 8;  // sags
  servo.advance(from_seconds(0.2));
  CHECK(servo.read(70, byte) == Refusal::none);
  CHECK(byte[0] == protocol2::input_voltage_error);
}

TEST_CASE("packets of the e-Manual get answers as it prints them") {
  Answerer<Protocol1> first(two(mx_64_protocol_1));
  CHECK(answers(first, "FF FF 01 02 01 FB") == "FF FF 01 02 00 FC");           // ping
  CHECK(answers(first, "FF FF 01 04 02 2B 01 CC") == "FF FF 01 03 00 23 D8");  // temperature: 35 degrees
  CHECK(answers(first, "FF FF FE 02 01 FE").empty());                          // none answers a broadcast
  CHECK(answers(first, "FF FF 01 02 01 FC").empty());                          // wrong check sum

  Answerer<Protocol2> second(two(mx_64_protocol_2));
  CHECK(answers(second, "FF FF FD 00 01 03 00 01 19 4E").substr(0, 30) == "FF FF FD 00 01 07 00 55 00 37 ");
  CHECK(answers(second, "FF FF FD 00 09 03 00 01 1A 9E").empty());  // nobody's id
}

TEST_CASE("each byte takes its time on the line, after the servo's return delay") {
  std::vector<VirtualServo> servos = two(mx_64_protocol_1);
  servos[0].set("return_delay_time", 250);  // 500 us
  Answerer<Protocol1> line(servos, {.bits_per_s = 1'000'000});
  line.receive(bytes_of("FF FF 01 02 01 FB"), from_seconds(1));
  REQUIRE(line.next_due().has_value());
  CHECK(*line.next_due() == from_seconds(1) + std::chrono::microseconds(60 + 500 + 60));
  std::array<std::uint8_t, 64> out;
  CHECK(line.take(*line.next_due() - Time(1), out) == 0);
  CHECK(line.take(*line.next_due(), out) == 6);
}

TEST_CASE("behind a silent servo the chain of a sync read stops, or goes on later") {
  for (const Chain chain : {Chain::stops, Chain::goes_on}) {
    Answerer<Protocol2> line(two(mx_64_protocol_2), {.chain = chain});
    line.set_silent(1, true);
    std::array<std::uint8_t, 64> packet;
    const std::array<std::uint8_t, 2> ids{1, 2};
    const std::string got = answers(line, hex_of(protocol2::sync_read(packet, 132, 4, ids)));
    CHECK(line.counts().silent == 1);
    CHECK(line.counts().withheld == (chain == Chain::stops ? 1 : 0));
    CHECK(got.empty() == (chain == Chain::stops));
  }
}

TEST_CASE("damage never leaves a packet as it was and stays within the bytes allowed") {
  surefoot::Rng rng(4);
  for (int i = 0; i < 2000; ++i) {
    std::array<std::uint8_t, 12> packet{};
    corrupt(packet, 2, rng);
    std::size_t first = packet.size(), last = 0;
    for (std::size_t j = 0; j < packet.size(); ++j) {
      if (packet[j] != 0) first = std::min(first, j), last = j;
    }
    REQUIRE(first < packet.size());
    REQUIRE(last - first <= 1);
  }
}
