// The control tables of MX-28 and MX-64 servos, as data, for the firmware of either protocol.
// ROBOTIS e-Manual, pages MX-28, MX-64, MX-28(2.0) and MX-64(2.0), section Control Table.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "packet.hpp"
#include "units.hpp"

namespace dynamixel {

enum class Access : std::uint8_t { read_only, read_write };

/// Of a register's value: counts times its factor. A share is of the maximum, 1 being all of it.
enum class Unit : std::uint8_t {
  none,
  radian,
  radian_per_second,
  radian_per_second2,
  second,
  volt,
  celsius,
  ampere,
  share
};

/// How bits make counts: as they are; two's complement; ten bits and a direction, clockwise negative; with 2048 as
/// zero.
enum class Encoding : std::uint8_t { unsigned_value, signed_value, direction_bit, centered };

/// Numbers of several bytes have the low byte first. Positions count from their own zero, center_ticks from a straight
/// joint. Gains have the factor of the e-Manual's control laws.
struct Register {
  std::string_view name;  // as in the e-Manual, in snake_case
  std::uint16_t address = 0;
  std::uint8_t size = 1;  // [bytes]
  Access access = Access::read_only;
  Unit unit = Unit::none;
  double factor = 1;  // [unit per count]
  Encoding encoding = Encoding::unsigned_value;
  std::uint16_t repeats = 1;  // one after the other, numbered from the name on

  constexpr std::size_t end() const { return std::size_t{address} + std::size_t{size} * repeats; }
};

/// What Baud Rate counts: 2 Mbit/s divided by one more, and three above; or one of eight speeds from 9600 bit/s on.
enum class BaudTable : std::uint8_t { divisor, list };

/// Of a servo out of its box [counts], but for its id 1 and a Return Delay Time of 250.
struct FactorySettings {
  std::uint8_t baud_rate = 1;
  std::uint16_t min_voltage_limit = 95, max_voltage_limit = 160;
  std::uint8_t temperature_limit = 80;
  std::uint16_t p_gain = 850;  // of the position
  double supply_v = 12;        // that it is made for, rounded [V]
};

/// A kind of servo with one of its firmwares. Registers are sorted by address.
struct ServoModel {
  std::string_view name;
  std::uint16_t model_number = 0;
  int protocol = 0;                     // 1 or 2
  std::uint16_t first_ram_address = 0;  // registers below keep their value without power
  std::span<const Register> registers;
  FactorySettings factory{};
  BaudTable bauds = BaudTable::list;
  std::uint8_t largest_baud_rate = 7;  // [counts]
  int center = center_ticks;           // where a joint is straight [ticks]
  double tick_rad = position_rad;      // [rad]

  /// Null if there is none of that name.
  constexpr const Register* find(std::string_view register_name) const {
    for (const Register& each : registers) {
      if (each.name == register_name) return &each;
    }
    return nullptr;
  }
};

/// The angle of a tick, from the centre [rad].
constexpr double angle_of(const ServoModel& model, double ticks) { return (ticks - model.center) * model.tick_rad; }

/// The nearest tick of its one turn; none for angles beyond it or not finite.
inline std::optional<std::uint16_t> ticks_of(const ServoModel& model, double angle_rad) {
  const double ticks = std::round(angle_rad / model.tick_rad + model.center);
  if (!(ticks >= 0 && ticks <= 2 * model.center - 1)) return std::nullopt;
  return static_cast<std::uint16_t>(ticks);
}

/// Of a register in bytes that begin at address `begin` and hold all of it.
constexpr std::uint32_t bits_in(Bytes bytes, std::size_t begin, const Register& r) {
  std::uint32_t bits = 0;
  for (std::size_t i = r.size; i-- > 0;) bits = (bits << 8) | bytes[r.address - begin + i];
  return bits;
}

/// The value of bits read; bits above the register's size do not matter.
constexpr double value_from_bits(const Register& r, std::uint32_t bits) {
  const std::uint32_t mask = r.size >= 4 ? 0xFFFFFFFFU : (1U << (8U * r.size)) - 1U;
  bits &= mask;
  double counts = bits;
  if (r.encoding == Encoding::signed_value && bits > mask / 2) counts -= static_cast<double>(mask) + 1.0;
  if (r.encoding == Encoding::direction_bit) {
    counts = bits & 0x3FFU;
    if ((bits & 0x400U) != 0) counts = -counts;
  }
  if (r.encoding == Encoding::centered) counts -= 2048.0;
  return counts * r.factor;
}

/// The bits of the nearest count; none for values beyond the register's size or not finite.
inline std::optional<std::uint32_t> bits_from_value(const Register& r, double value) {
  const double whole = std::ldexp(1.0, 8 * r.size);  // one more than the largest number of that size
  double counts = std::round(value / r.factor);
  if (!std::isfinite(counts)) return std::nullopt;
  if (r.encoding == Encoding::centered) counts += 2048.0;
  double least = 0, most = whole - 1;
  if (r.encoding == Encoding::signed_value) least = -whole / 2, most = whole / 2 - 1;
  if (r.encoding == Encoding::direction_bit) least = -1023, most = 1023;
  if (counts < least || counts > most) return std::nullopt;
  if (counts >= 0) return static_cast<std::uint32_t>(counts);
  if (r.encoding == Encoding::direction_bit) return 0x400U | static_cast<std::uint32_t>(-counts);
  return static_cast<std::uint32_t>(whole + counts);
}

namespace control_table_detail {

/// The registers of both tables, sorted by address.
template <std::size_t N, std::size_t M>
constexpr std::array<Register, N + M> with_more(const std::array<Register, N>& table,
                                                const std::array<Register, M>& more) {
  std::array<Register, N + M> result;
  std::copy(more.begin(), more.end(), std::copy(table.begin(), table.end(), result.begin()));
  std::sort(result.begin(), result.end(), [](const Register& a, const Register& b) { return a.address < b.address; });
  return result;
}

inline constexpr Access read_only = Access::read_only, read_write = Access::read_write;

inline constexpr std::array mx_28_protocol_1{
    Register{"model_number", 0, 2, read_only},
    Register{"firmware_version", 2, 1, read_only},
    Register{"id", 3, 1, read_write},
    Register{"baud_rate", 4, 1, read_write},
    Register{"return_delay_time", 5, 1, read_write, Unit::second, return_delay_s},
    Register{"cw_angle_limit", 6, 2, read_write, Unit::radian, position_rad},
    Register{"ccw_angle_limit", 8, 2, read_write, Unit::radian, position_rad},
    Register{"temperature_limit", 11, 1, read_write, Unit::celsius, temperature_celsius},
    Register{"min_voltage_limit", 12, 1, read_write, Unit::volt, voltage_v},
    Register{"max_voltage_limit", 13, 1, read_write, Unit::volt, voltage_v},
    Register{"max_torque", 14, 2, read_write, Unit::share, load_share},
    Register{"status_return_level", 16, 1, read_write},
    Register{"alarm_led", 17, 1, read_write},
    Register{"shutdown", 18, 1, read_write},
    Register{"multi_turn_offset", 20, 2, read_write, Unit::radian, position_rad, Encoding::signed_value},
    Register{"resolution_divider", 22, 1, read_write},
    Register{"torque_enable", 24, 1, read_write},
    Register{"led", 25, 1, read_write},
    Register{"d_gain", 26, 1, read_write, Unit::none, 0.004},
    Register{"i_gain", 27, 1, read_write, Unit::none, 1000.0 / 2048.0},
    Register{"p_gain", 28, 1, read_write, Unit::none, 0.125},
    Register{"goal_position", 30, 2, read_write, Unit::radian, position_rad, Encoding::signed_value},
    Register{"moving_speed", 32, 2, read_write, Unit::radian_per_second, speed1_rad_per_s, Encoding::direction_bit},
    Register{"torque_limit", 34, 2, read_write, Unit::share, load_share},
    Register{"present_position", 36, 2, read_only, Unit::radian, position_rad, Encoding::signed_value},
    Register{"present_speed", 38, 2, read_only, Unit::radian_per_second, speed1_rad_per_s, Encoding::direction_bit},
    Register{"present_load", 40, 2, read_only, Unit::share, load_share, Encoding::direction_bit},
    Register{"present_voltage", 42, 1, read_only, Unit::volt, voltage_v},
    Register{"present_temperature", 43, 1, read_only, Unit::celsius, temperature_celsius},
    Register{"registered", 44, 1, read_only},
    Register{"moving", 46, 1, read_only},
    Register{"lock", 47, 1, read_write},
    Register{"punch", 48, 2, read_write},
    Register{"realtime_tick", 50, 2, read_only, Unit::second, realtime_tick_s},
    Register{"goal_acceleration", 73, 1, read_write, Unit::radian_per_second2, acceleration1_rad_per_s2}};

/// Measures and controls its current as well.
inline constexpr std::array mx_64_protocol_1 = with_more(
    mx_28_protocol_1,
    std::array{Register{"current", 68, 2, read_write, Unit::ampere, current1_a, Encoding::centered},
               Register{"torque_ctrl_mode_enable", 70, 1, read_write},
               Register{"goal_torque", 71, 2, read_write, Unit::ampere, current1_a, Encoding::direction_bit}});

inline constexpr std::array common_protocol_2{
    Register{"model_number", 0, 2, read_only},
    Register{"model_information", 2, 4, read_only},
    Register{"firmware_version", 6, 1, read_only},
    Register{"id", 7, 1, read_write},
    Register{"baud_rate", 8, 1, read_write},
    Register{"return_delay_time", 9, 1, read_write, Unit::second, return_delay_s},
    Register{"drive_mode", 10, 1, read_write},
    Register{"operating_mode", 11, 1, read_write},
    Register{"secondary_id", 12, 1, read_write},
    Register{"protocol_version", 13, 1, read_write},
    Register{"homing_offset", 20, 4, read_write, Unit::radian, position_rad, Encoding::signed_value},
    Register{"moving_threshold", 24, 4, read_write, Unit::radian_per_second, velocity2_rad_per_s},
    Register{"temperature_limit", 31, 1, read_write, Unit::celsius, temperature_celsius},
    Register{"max_voltage_limit", 32, 2, read_write, Unit::volt, voltage_v},
    Register{"min_voltage_limit", 34, 2, read_write, Unit::volt, voltage_v},
    Register{"pwm_limit", 36, 2, read_write, Unit::share, pwm_share},
    Register{"acceleration_limit", 40, 4, read_write, Unit::radian_per_second2, acceleration2_rad_per_s2},
    Register{"velocity_limit", 44, 4, read_write, Unit::radian_per_second, velocity2_rad_per_s},
    Register{"max_position_limit", 48, 4, read_write, Unit::radian, position_rad},
    Register{"min_position_limit", 52, 4, read_write, Unit::radian, position_rad},
    Register{"shutdown", 63, 1, read_write},
    Register{"torque_enable", 64, 1, read_write},
    Register{"led", 65, 1, read_write},
    Register{"status_return_level", 68, 1, read_write},
    Register{"registered_instruction", 69, 1, read_only},
    Register{"hardware_error_status", 70, 1, read_only},
    Register{"velocity_i_gain", 76, 2, read_write, Unit::none, 1.0 / 65536.0},
    Register{"velocity_p_gain", 78, 2, read_write, Unit::none, 1.0 / 128.0},
    Register{"position_d_gain", 80, 2, read_write, Unit::none, 1.0 / 16.0},
    Register{"position_i_gain", 82, 2, read_write, Unit::none, 1.0 / 65536.0},
    Register{"position_p_gain", 84, 2, read_write, Unit::none, 1.0 / 128.0},
    Register{"feedforward_2nd_gain", 88, 2, read_write, Unit::none, 0.25},
    Register{"feedforward_1st_gain", 90, 2, read_write, Unit::none, 0.25},
    Register{"bus_watchdog", 98, 1, read_write, Unit::second, bus_watchdog_s, Encoding::signed_value},
    Register{"goal_pwm", 100, 2, read_write, Unit::share, pwm_share, Encoding::signed_value},
    Register{"goal_velocity", 104, 4, read_write, Unit::radian_per_second, velocity2_rad_per_s, Encoding::signed_value},
    Register{"profile_acceleration", 108, 4, read_write, Unit::radian_per_second2, acceleration2_rad_per_s2},
    Register{"profile_velocity", 112, 4, read_write, Unit::radian_per_second, velocity2_rad_per_s},
    Register{"goal_position", 116, 4, read_write, Unit::radian, position_rad, Encoding::signed_value},
    Register{"realtime_tick", 120, 2, read_only, Unit::second, realtime_tick_s},
    Register{"moving", 122, 1, read_only},
    Register{"moving_status", 123, 1, read_only},
    Register{"present_pwm", 124, 2, read_only, Unit::share, pwm_share, Encoding::signed_value},
    Register{"present_velocity", 128, 4, read_only, Unit::radian_per_second, velocity2_rad_per_s,
             Encoding::signed_value},
    Register{"present_position", 132, 4, read_only, Unit::radian, position_rad, Encoding::signed_value},
    Register{"velocity_trajectory", 136, 4, read_only, Unit::radian_per_second, velocity2_rad_per_s,
             Encoding::signed_value},
    Register{"position_trajectory", 140, 4, read_only, Unit::radian, position_rad, Encoding::signed_value},
    Register{"present_input_voltage", 144, 2, read_only, Unit::volt, voltage_v},
    Register{"present_temperature", 146, 1, read_only, Unit::celsius, temperature_celsius},
    Register{"indirect_address_1", 168, 2, read_write, Unit::none, 1, Encoding::unsigned_value, 28},
    Register{"indirect_data_1", 224, 1, read_write, Unit::none, 1, Encoding::unsigned_value, 28},
    Register{"indirect_address_29", 578, 2, read_write, Unit::none, 1, Encoding::unsigned_value, 28},
    Register{"indirect_data_29", 634, 1, read_write, Unit::none, 1, Encoding::unsigned_value, 28}};

inline constexpr std::array mx_28_protocol_2 =
    with_more(common_protocol_2,
              std::array{Register{"present_load", 126, 2, read_only, Unit::share, load_share, Encoding::signed_value}});

inline constexpr std::array mx_64_protocol_2 = with_more(
    common_protocol_2,
    std::array{Register{"current_limit", 38, 2, read_write, Unit::ampere, current2_a},
               Register{"goal_current", 102, 2, read_write, Unit::ampere, current2_a, Encoding::signed_value},
               Register{"present_current", 126, 2, read_only, Unit::ampere, current2_a, Encoding::signed_value}});

}  // namespace control_table_detail

namespace control_table_detail {

inline constexpr FactorySettings mx_factory_1{34, 60, 160, 80, 32};

}  // namespace control_table_detail

inline constexpr ServoModel mx_28_protocol_1{
    "MX-28", 29, 1, 24, control_table_detail::mx_28_protocol_1, control_table_detail::mx_factory_1, BaudTable::divisor,
    252};
inline constexpr ServoModel mx_64_protocol_1{
    "MX-64", 310, 1, 24, control_table_detail::mx_64_protocol_1, control_table_detail::mx_factory_1, BaudTable::divisor,
    252};
inline constexpr ServoModel mx_28_protocol_2{"MX-28(2.0)", 30, 2, 64, control_table_detail::mx_28_protocol_2};
inline constexpr ServoModel mx_64_protocol_2{"MX-64(2.0)", 311, 2, 64, control_table_detail::mx_64_protocol_2};

}  // namespace dynamixel
