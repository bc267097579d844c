// All servos known here: the control tables of MX-106, of the X series, of XL-320 and AX-12 as data, and every model by
// its number.
// ROBOTIS e-Manual, pages MX-106, MX-106(2.0), XL330-M077, XL330-M288, XL430-W250, XM430, XM540, XH430, XH540 (W
// versions), XL-320 and AX-12A, section Control Table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "control_tables.hpp"
#include "units.hpp"

namespace dynamixel {

inline constexpr double tick10_rad = 300.0 / 1024.0 * degree_rad;   // of a tick of AX-12 and XL-320 [rad]
inline constexpr double speed10_rad_per_s = 0.111 * rpm_rad_per_s;  // of a count of AX-12 and XL-320 [rad/s]
inline constexpr double current_x_a = 0.00269;                      // of a count, XM and XH [A]
inline constexpr double current_xl330_a = 0.001;                    // of a count [A]

namespace control_table_detail {

inline constexpr std::array mx_106_protocol_1 =
    with_more(mx_64_protocol_1, std::array{Register{"drive_mode", 10, 1, read_write}});

/// The registers with these names are not there.
template <std::size_t N, std::size_t M>
constexpr std::array<Register, N - M> without(const std::array<Register, N>& table,
                                              const std::array<std::string_view, M>& names) {
  std::array<Register, N - M> result;
  std::size_t kept = 0;
  for (const Register& r : table) {
    bool left_out = false;
    for (const std::string_view name : names) left_out = left_out || r.name == name;
    if (!left_out) result[kept++] = r;
  }
  return result;
}

inline constexpr std::array x_common = with_more(
    without(common_protocol_2, std::array<std::string_view, 1>{"acceleration_limit"}),
    std::array{Register{"startup_configuration", 60, 1, read_write}, Register{"backup_ready", 147, 1, read_only}});

inline constexpr std::array xl430 = with_more(
    x_common, std::array{Register{"present_load", 126, 2, read_only, Unit::share, load_share, Encoding::signed_value}});

template <std::size_t N>
constexpr std::array<Register, N + 3> with_current(const std::array<Register, N>& table, double ampere) {
  return with_more(
      table, std::array{Register{"current_limit", 38, 2, read_write, Unit::ampere, ampere},
                        Register{"goal_current", 102, 2, read_write, Unit::ampere, ampere, Encoding::signed_value},
                        Register{"present_current", 126, 2, read_only, Unit::ampere, ampere, Encoding::signed_value}});
}

inline constexpr std::array x430 = with_current(x_common, current_x_a);

inline constexpr std::array x540 = with_more(x430, std::array{Register{"external_port_mode_1", 56, 1, read_write},
                                                              Register{"external_port_mode_2", 57, 1, read_write},
                                                              Register{"external_port_mode_3", 58, 1, read_write},
                                                              Register{"external_port_data_1", 152, 2, read_write},
                                                              Register{"external_port_data_2", 154, 2, read_write},
                                                              Register{"external_port_data_3", 156, 2, read_write}});

inline constexpr std::array xl330 = with_more(
    with_current(without(x_common, std::array<std::string_view, 4>{"indirect_address_1", "indirect_data_1",
                                                                   "indirect_address_29", "indirect_data_29"}),
                 current_xl330_a),
    std::array{Register{"pwm_slope", 62, 1, read_write},
               Register{"indirect_address_1", 168, 2, read_write, Unit::none, 1, Encoding::unsigned_value, 20},
               Register{"indirect_data_1", 208, 1, read_write, Unit::none, 1, Encoding::unsigned_value, 20}});

inline constexpr std::array ax_12{
    Register{"model_number", 0, 2, read_only},
    Register{"firmware_version", 2, 1, read_only},
    Register{"id", 3, 1, read_write},
    Register{"baud_rate", 4, 1, read_write},
    Register{"return_delay_time", 5, 1, read_write, Unit::second, return_delay_s},
    Register{"cw_angle_limit", 6, 2, read_write, Unit::radian, tick10_rad},
    Register{"ccw_angle_limit", 8, 2, read_write, Unit::radian, tick10_rad},
    Register{"temperature_limit", 11, 1, read_write, Unit::celsius, temperature_celsius},
    Register{"min_voltage_limit", 12, 1, read_write, Unit::volt, voltage_v},
    Register{"max_voltage_limit", 13, 1, read_write, Unit::volt, voltage_v},
    Register{"max_torque", 14, 2, read_write, Unit::share, load_share},
    Register{"status_return_level", 16, 1, read_write},
    Register{"alarm_led", 17, 1, read_write},
    Register{"shutdown", 18, 1, read_write},
    Register{"torque_enable", 24, 1, read_write},
    Register{"led", 25, 1, read_write},
    Register{"cw_compliance_margin", 26, 1, read_write},
    Register{"ccw_compliance_margin", 27, 1, read_write},
    Register{"cw_compliance_slope", 28, 1, read_write},
    Register{"ccw_compliance_slope", 29, 1, read_write},
    Register{"goal_position", 30, 2, read_write, Unit::radian, tick10_rad},
    Register{"moving_speed", 32, 2, read_write, Unit::radian_per_second, speed10_rad_per_s, Encoding::direction_bit},
    Register{"torque_limit", 34, 2, read_write, Unit::share, load_share},
    Register{"present_position", 36, 2, read_only, Unit::radian, tick10_rad},
    Register{"present_speed", 38, 2, read_only, Unit::radian_per_second, speed10_rad_per_s, Encoding::direction_bit},
    Register{"present_load", 40, 2, read_only, Unit::share, load_share, Encoding::direction_bit},
    Register{"present_voltage", 42, 1, read_only, Unit::volt, voltage_v},
    Register{"present_temperature", 43, 1, read_only, Unit::celsius, temperature_celsius},
    Register{"registered", 44, 1, read_only},
    Register{"moving", 46, 1, read_only},
    Register{"lock", 47, 1, read_write},
    Register{"punch", 48, 2, read_write}};

inline constexpr std::array xl_320{
    Register{"model_number", 0, 2, read_only},
    Register{"firmware_version", 2, 1, read_only},
    Register{"id", 3, 1, read_write},
    Register{"baud_rate", 4, 1, read_write},
    Register{"return_delay_time", 5, 1, read_write, Unit::second, return_delay_s},
    Register{"cw_angle_limit", 6, 2, read_write, Unit::radian, tick10_rad},
    Register{"ccw_angle_limit", 8, 2, read_write, Unit::radian, tick10_rad},
    Register{"control_mode", 11, 1, read_write},
    Register{"temperature_limit", 12, 1, read_write, Unit::celsius, temperature_celsius},
    Register{"min_voltage_limit", 13, 1, read_write, Unit::volt, voltage_v},
    Register{"max_voltage_limit", 14, 1, read_write, Unit::volt, voltage_v},
    Register{"max_torque", 15, 2, read_write, Unit::share, load_share},
    Register{"status_return_level", 17, 1, read_write},
    Register{"shutdown", 18, 1, read_write},
    Register{"torque_enable", 24, 1, read_write},
    Register{"led", 25, 1, read_write},
    Register{"d_gain", 27, 1, read_write},
    Register{"i_gain", 28, 1, read_write},
    Register{"p_gain", 29, 1, read_write},
    Register{"goal_position", 30, 2, read_write, Unit::radian, tick10_rad},
    Register{"moving_speed", 32, 2, read_write, Unit::radian_per_second, speed10_rad_per_s, Encoding::direction_bit},
    Register{"torque_limit", 35, 2, read_write, Unit::share, load_share},
    Register{"present_position", 37, 2, read_only, Unit::radian, tick10_rad},
    Register{"present_speed", 39, 2, read_only, Unit::radian_per_second, speed10_rad_per_s, Encoding::direction_bit},
    Register{"present_load", 41, 2, read_only, Unit::share, load_share, Encoding::direction_bit},
    Register{"present_voltage", 45, 1, read_only, Unit::volt, voltage_v},
    Register{"present_temperature", 46, 1, read_only, Unit::celsius, temperature_celsius},
    Register{"registered_instruction", 47, 1, read_only},
    Register{"moving", 49, 1, read_only},
    Register{"hardware_error_status", 50, 1, read_only},
    Register{"punch", 51, 2, read_write}};

inline constexpr FactorySettings xl330_factory{1, 35, 70, 70, 400, 5}, xl430_factory{1, 60, 140, 72, 640},
    x_factory{1, 95, 160, 80, 800}, xh430_factory{1, 95, 160, 80, 900}, xl320_factory{3, 60, 90, 65, 32, 7.4},
    ax_factory{1, 60, 140, 70, 0};

}  // namespace control_table_detail

inline constexpr ServoModel mx_106_protocol_1{
    "MX-106",           320, 1, 24, control_table_detail::mx_106_protocol_1, control_table_detail::mx_factory_1,
    BaudTable::divisor, 252};
inline constexpr ServoModel mx_106_protocol_2{"MX-106(2.0)", 321, 2, 64, control_table_detail::mx_64_protocol_2};
inline constexpr ServoModel ax_12{
    "AX-12", 12,  1,         24, control_table_detail::ax_12, control_table_detail::ax_factory, BaudTable::divisor,
    254,     512, tick10_rad};
inline constexpr ServoModel xl_320{
    "XL-320",        350, 2,   24,        control_table_detail::xl_320, control_table_detail::xl320_factory,
    BaudTable::list, 3,   512, tick10_rad};
inline constexpr ServoModel xl430_w250{
    "XL430-W250", 1060, 2, 64, control_table_detail::xl430, control_table_detail::xl430_factory};
inline constexpr ServoModel xm430_w350{
    "XM430-W350", 1020, 2, 64, control_table_detail::x430, control_table_detail::x_factory};

namespace control_table_detail {

constexpr ServoModel xl330_model(std::string_view name, std::uint16_t number) {
  return {name, number, 2, 64, xl330, xl330_factory, BaudTable::list, 6};
}

}  // namespace control_table_detail

/// All that are known.
inline constexpr std::array servo_models{
    mx_28_protocol_1,
    mx_64_protocol_1,
    mx_106_protocol_1,
    mx_28_protocol_2,
    mx_64_protocol_2,
    mx_106_protocol_2,
    ax_12,
    xl_320,
    control_table_detail::xl330_model("XL330-M077", 1190),
    control_table_detail::xl330_model("XL330-M288", 1200),
    xl430_w250,
    xm430_w350,
    ServoModel{"XM430-W210", 1030, 2, 64, control_table_detail::x430, control_table_detail::x_factory},
    ServoModel{"XM540-W270", 1120, 2, 64, control_table_detail::x540, control_table_detail::x_factory},
    ServoModel{"XM540-W150", 1130, 2, 64, control_table_detail::x540, control_table_detail::x_factory},
    ServoModel{"XH430-W350", 1000, 2, 64, control_table_detail::x430, control_table_detail::xh430_factory},
    ServoModel{"XH430-W210", 1010, 2, 64, control_table_detail::x430, control_table_detail::xh430_factory},
    ServoModel{"XH540-W270", 1100, 2, 64, control_table_detail::x540, control_table_detail::x_factory},
    ServoModel{"XH540-W150", 1110, 2, 64, control_table_detail::x540, control_table_detail::x_factory}};

/// Null where the number is none of those known.
constexpr const ServoModel* find_model(unsigned number) {
  for (const ServoModel& model : servo_models) {
    if (model.model_number == number) return &model;
  }
  return nullptr;
}

/// Null where there is none of that name.
constexpr const ServoModel* find_model(std::string_view name) {
  for (const ServoModel& model : servo_models) {
    if (model.name == name) return &model;
  }
  return nullptr;
}

/// Of a value of Baud Rate [bit/s]; none for values that the model does not have.
constexpr std::optional<std::uint32_t> bits_per_s_of(const ServoModel& model, unsigned baud_rate) {
  if (baud_rate > model.largest_baud_rate) return std::nullopt;
  if (model.bauds == BaudTable::list) return baud2_rates[baud_rate];
  constexpr std::array<std::uint32_t, 3> fast{2'250'000, 2'500'000, 3'000'000};
  if (baud_rate >= 250 && model.largest_baud_rate == 252) return fast[baud_rate - 250];
  return 2'000'000 / (baud_rate + 1);
}

/// The value of Baud Rate; none for speeds that the model cannot do.
constexpr std::optional<std::uint8_t> baud_rate_of(const ServoModel& model, std::uint32_t bits_per_s) {
  const auto value =
      model.bauds == BaudTable::list ? baud2_from_bits_per_s(bits_per_s) : baud1_from_bits_per_s(bits_per_s);
  if (value && (*value > model.largest_baud_rate || (model.largest_baud_rate == 254 && bits_per_s > 1'000'000))) {
    return std::nullopt;
  }
  return value;
}

}  // namespace dynamixel
