#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/dynamixel/control_tables.hpp"
#include "examples/sigmaban/robot/dynamixel/servo_models.hpp"
#include "examples/sigmaban/robot/dynamixel/units.hpp"

using namespace dynamixel;

namespace {

const Register& at(const ServoModel& model, std::string_view name) {
  const Register* found = model.find(name);
  REQUIRE(found != nullptr);
  return *found;
}

}  // namespace

TEST_CASE("registers are sorted, do not overlap and have sizes of the protocol") {
  for (const ServoModel& model : servo_models) {
    CAPTURE(model.name);
    std::size_t end = 0;
    for (const Register& r : model.registers) {
      CAPTURE(r.name);
      CHECK(r.address >= end);
      end = r.end();
      CHECK((r.size == 1 || r.size == 2 || r.size == 4));
      CHECK(r.factor > 0);
      CHECK(&at(model, r.name) == &r);  // no name twice
      if (model.protocol == 1) CHECK(r.end() <= 256);
    }
  }
  CHECK(mx_64_protocol_1.find("goal_current") == nullptr);
}

TEST_CASE("registers of the e-Manual are where it says") {
  CHECK(at(mx_28_protocol_1, "goal_position").address == 30);
  CHECK(at(mx_28_protocol_1, "present_position").address == 36);
  CHECK(at(mx_28_protocol_1, "present_temperature").address == 43);
  CHECK(at(mx_28_protocol_1, "goal_acceleration").address == 73);
  CHECK(mx_28_protocol_1.find("current") == nullptr);
  CHECK(at(mx_64_protocol_1, "current").address == 68);
  CHECK(at(mx_64_protocol_1, "goal_torque").address == 71);
  CHECK(at(mx_28_protocol_2, "goal_position").address == 116);
  CHECK(at(mx_28_protocol_2, "present_load").address == 126);
  CHECK(mx_28_protocol_2.find("current_limit") == nullptr);
  CHECK(at(mx_64_protocol_2, "present_current").address == 126);
  CHECK(at(mx_64_protocol_2, "present_position").address == 132);
  CHECK(at(mx_64_protocol_2, "present_position").size == 4);
  CHECK(at(mx_64_protocol_2, "present_input_voltage").address == 144);
  CHECK(at(mx_64_protocol_2, "indirect_data_29").end() == 662);  // the last is 56, at 661
  CHECK(at(mx_64_protocol_2, "present_position").access == Access::read_only);
  CHECK(at(mx_64_protocol_2, "goal_position").access == Access::read_write);
  CHECK(mx_64_protocol_1.registers.size() == mx_28_protocol_1.registers.size() + 3);
  CHECK(mx_64_protocol_2.registers.size() == mx_28_protocol_2.registers.size() + 2);
}

TEST_CASE("worked values of the e-Manual come out") {
  const auto near = [](double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; };
  // Moving Speed: 300 is 34.2 rpm, 1023 is 116.62 rpm
  CHECK(near(value_from_bits(at(mx_28_protocol_1, "moving_speed"), 300) / rpm_rad_per_s, 34.2, 1e-9));
  CHECK(near(value_from_bits(at(mx_28_protocol_1, "moving_speed"), 1023) / rpm_rad_per_s, 116.62, 0.01));
  CHECK(value_from_bits(at(mx_28_protocol_1, "present_speed"), 1024 + 300) < 0);  // clockwise
  CHECK(value_from_bits(at(mx_28_protocol_1, "present_speed"), 1024) == 0);
  CHECK(near(value_from_bits(at(mx_28_protocol_1, "present_load"), 512), 0.5, 0.02));
  // Current: 2148 is 450 mA
  CHECK(near(value_from_bits(at(mx_64_protocol_1, "current"), 2148), 0.45, 1e-12));
  CHECK(near(amperes_from_current1(2148), 0.45, 1e-12));
  // Goal Acceleration: 10 is 14.3 rpm after a second
  CHECK(near(value_from_bits(at(mx_28_protocol_1, "goal_acceleration"), 10) / rpm_rad_per_s, 14.3, 0.01));
  CHECK(near(value_from_bits(at(mx_28_protocol_1, "goal_acceleration"), 254) / degree_rad, 2180, 0.1));
  // Return Delay Time: 250 is 500 us; BUS Watchdog: 100 is 2 s, -1 is its error
  CHECK(near(value_from_bits(at(mx_28_protocol_1, "return_delay_time"), 250), 500e-6, 1e-12));
  CHECK(near(value_from_bits(at(mx_28_protocol_2, "bus_watchdog"), 100), 2, 1e-12));
  CHECK(value_from_bits(at(mx_28_protocol_2, "bus_watchdog"), 0xFF) < 0);
  // PWM Limit: 885 is 100 %
  CHECK(near(value_from_bits(at(mx_28_protocol_2, "pwm_limit"), 885), 1, 1e-12));
  CHECK(near(value_from_bits(at(mx_64_protocol_2, "present_input_voltage"), 119), 11.9, 1e-12));
  CHECK(near(value_from_bits(at(mx_64_protocol_2, "present_position"), 0xFFFFFFFF), -position_rad, 1e-12));
}

TEST_CASE("values become bits and bits become the same values") {
  for (const ServoModel& model : servo_models) {
    for (const Register& r : model.registers) {
      CAPTURE(r.name);
      for (const std::uint32_t bits : {0U, 1U, 100U, 127U}) {
        CHECK(bits_from_value(r, value_from_bits(r, bits)) == bits);
      }
      CHECK_FALSE(bits_from_value(r, NAN));
      CHECK_FALSE(bits_from_value(r, HUGE_VAL));
      CHECK_FALSE(bits_from_value(r, r.factor * std::ldexp(1.0, 8 * r.size)));
    }
  }
  CHECK(bits_from_value(at(mx_64_protocol_2, "goal_position"), -position_rad) == 0xFFFFFFFFU);
  CHECK(bits_from_value(at(mx_64_protocol_2, "goal_current"), -current2_a) == 0xFFFFU);
  CHECK(bits_from_value(at(mx_28_protocol_1, "moving_speed"), -300 * speed1_rad_per_s) == 1324U);
  CHECK_FALSE(bits_from_value(at(mx_28_protocol_1, "moving_speed"), -1024 * speed1_rad_per_s));
  CHECK_FALSE(bits_from_value(at(mx_28_protocol_2, "pwm_limit"), -0.5));
}

TEST_CASE("angles become ticks within one turn") {
  CHECK(ticks_from_radians(0) == 2048);
  CHECK(radians_from_ticks(2048) == 0);
  CHECK(radians_from_ticks(3072) == doctest::Approx(1.5707963267948966));
  for (int ticks = 0; ticks <= max_ticks; ++ticks) CHECK(ticks_from_radians(radians_from_ticks(ticks)) == ticks);
  CHECK_FALSE(ticks_from_radians(3.1416));
  CHECK_FALSE(ticks_from_radians(-3.15));
  CHECK_FALSE(ticks_from_radians(NAN));
  CHECK(moving_speed1_from_rad_per_s(1e-9) == 1);  // 0 would be no limit at all
  CHECK(moving_speed1_from_rad_per_s(1e9) == 1023);
  CHECK_FALSE(moving_speed1_from_rad_per_s(0));
  CHECK_FALSE(moving_speed1_from_rad_per_s(NAN));
  CHECK(rad_per_s_from_speed1(1024 + 100) == -rad_per_s_from_speed1(100));
  CHECK(rad_per_s_from_velocity2(-10) / rpm_rad_per_s == doctest::Approx(-2.29));
  CHECK(volts_from_voltage(119) == doctest::Approx(11.9));
  CHECK(celsius_from_temperature(36) == 36);
}

TEST_CASE("baud rates have the values of the e-Manual") {
  CHECK(baud1_from_bits_per_s(1'000'000) == 1);
  CHECK(baud1_from_bits_per_s(500'000) == 3);
  CHECK(baud1_from_bits_per_s(115'200) == 16);
  CHECK(baud1_from_bits_per_s(57'600) == 34);
  CHECK(baud1_from_bits_per_s(19'200) == 103);
  CHECK(baud1_from_bits_per_s(9'600) == 207);
  CHECK(baud1_from_bits_per_s(3'000'000) == 252);
  CHECK_FALSE(baud1_from_bits_per_s(800'000));
  CHECK_FALSE(baud1_from_bits_per_s(0));
  CHECK(baud2_from_bits_per_s(57'600) == 1);
  CHECK(baud2_from_bits_per_s(1'000'000) == 3);
  CHECK(baud2_from_bits_per_s(3'000'000) == 5);
  CHECK_FALSE(baud2_from_bits_per_s(123));
}

TEST_CASE("models are found by number and by name; their registers are where the e-Manual says") {
  for (const ServoModel& model : servo_models) {
    CHECK(find_model(model.model_number) == &model);
    CHECK(find_model(model.name) == &model);
    CHECK(at(model, "model_number").address == 0);
    CHECK(at(model, "torque_enable").address == model.first_ram_address);
    const std::uint8_t baud_rate = model.factory.baud_rate;
    const std::uint32_t new_speed = model.name == "AX-12" || model.name == "XL-320" ? 1'000'000 : 57'600;
    CHECK(bits_per_s_of(model, baud_rate).value() / static_cast<double>(new_speed) == doctest::Approx(1).epsilon(0.01));
    CHECK(baud_rate_of(model, new_speed) == baud_rate);
  }
  CHECK(find_model(9999U) == nullptr);
  CHECK(find_model("AX-18") == nullptr);
  CHECK(at(*find_model("MX-106"), "drive_mode").address == 10);
  CHECK(find_model("XL430-W250")->find("present_current") == nullptr);
  CHECK(at(*find_model("XL430-W250"), "present_load").address == 126);
  CHECK(find_model("XM430-W350")->find("acceleration_limit") == nullptr);
  CHECK(value_from_bits(at(*find_model("XM540-W270"), "present_current"), 1000) == doctest::Approx(2.69));
  CHECK(at(*find_model("XH540-W150"), "external_port_data_3").address == 156);
  CHECK(value_from_bits(at(*find_model("XL330-M288"), "goal_current"), 1750) == doctest::Approx(1.75));
  CHECK(at(*find_model("XL330-M288"), "indirect_data_1").end() == 228);
  CHECK(at(*find_model("XL-320"), "present_position").address == 37);
  CHECK(at(*find_model("AX-12"), "ccw_compliance_slope").address == 29);
  CHECK(value_from_bits(at(*find_model("AX-12"), "goal_position"), 512) == doctest::Approx(150 * degree_rad));
  CHECK_FALSE(baud_rate_of(*find_model("XL330-M288"), 4'500'000));
  CHECK_FALSE(baud_rate_of(*find_model("XL-320"), 2'000'000));
  CHECK_FALSE(baud_rate_of(*find_model("AX-12"), 3'000'000));
  CHECK(baud_rate_of(*find_model("MX-28"), 3'000'000) == 252);
}
