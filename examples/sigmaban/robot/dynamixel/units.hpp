// Between the counts in the registers of MX servos and SI units.
// ROBOTIS e-Manual, pages MX-28, MX-64, MX-28(2.0) and MX-64(2.0), section Control Table Description.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace dynamixel {

inline constexpr double degree_rad = std::numbers::pi / 180.0;           // [rad]
inline constexpr double rpm_rad_per_s = 2.0 * std::numbers::pi / 60.0;   // [rad/s]
inline constexpr double position_rad = 2.0 * std::numbers::pi / 4096.0;  // of a tick [rad]
inline constexpr double speed1_rad_per_s = 0.114 * rpm_rad_per_s;        // of a count, Protocol 1.0 [rad/s]
inline constexpr double velocity2_rad_per_s = 0.229 * rpm_rad_per_s;     // of a count, Protocol 2.0 [rad/s]
inline constexpr double acceleration1_rad_per_s2 = 8.583 * degree_rad;   // of a count, Protocol 1.0 [rad/s^2]
inline constexpr double acceleration2_rad_per_s2 =                       // of a count, Protocol 2.0: 214.577 rev/min^2
    214.577 * 2.0 * std::numbers::pi / 3600.0;                           // [rad/s^2]
inline constexpr double voltage_v = 0.1;                                 // of a count [V]
inline constexpr double temperature_celsius = 1.0;                       // of a count [degrees C]
inline constexpr double load_share = 0.001;                              // of a count; 1 is the maximum torque
inline constexpr double pwm_share = 1.0 / 885.0;                         // of a count, 0.113 %; 1 is the full voltage
inline constexpr double current1_a = 0.0045;                             // of a count, MX-64 Protocol 1.0 [A]
inline constexpr double current2_a = 0.00336;                            // of a count, MX-64 Protocol 2.0 [A]
inline constexpr double return_delay_s = 2e-6;                           // of a count [s]
inline constexpr double bus_watchdog_s = 0.02;                           // of a count, Protocol 2.0 [s]
inline constexpr double realtime_tick_s = 0.001;                         // of a count [s]

inline constexpr int center_ticks = 2048;  // where a joint is straight
inline constexpr int max_ticks = 4095;

/// From the centre, counterclockwise, seen from the front of the servo [rad].
constexpr double radians_from_ticks(std::int32_t ticks) { return (ticks - center_ticks) * position_rad; }

/// The nearest tick of one turn; none for angles beyond it or not finite.
inline std::optional<std::uint16_t> ticks_from_radians(double angle_rad) {
  const double ticks = std::round(angle_rad / position_rad + center_ticks);
  if (!(ticks >= 0 && ticks <= max_ticks)) return std::nullopt;
  return static_cast<std::uint16_t>(ticks);
}

/// Protocol 1.0: ten bits and a direction, counterclockwise positive [rad/s].
constexpr double rad_per_s_from_speed1(std::uint16_t speed) {
  const double size = (speed & 0x3FF) * speed1_rad_per_s;
  return (speed & 0x400) != 0 ? -size : size;
}

/// Protocol 1.0, Moving Speed of a joint, which has no direction: the nearest count, at least 1, because 0 stands for
/// no limit, and at most 1023. None for speeds that are not positive or not finite.
inline std::optional<std::uint16_t> moving_speed1_from_rad_per_s(double speed_rad_per_s) {
  if (!(speed_rad_per_s > 0) || !std::isfinite(speed_rad_per_s)) return std::nullopt;
  const double count = std::round(speed_rad_per_s / speed1_rad_per_s);
  return static_cast<std::uint16_t>(count < 1 ? 1 : count > 1023 ? 1023 : count);
}

/// Protocol 2.0 [rad/s].
constexpr double rad_per_s_from_velocity2(std::int32_t velocity) { return velocity * velocity2_rad_per_s; }

constexpr double volts_from_voltage(std::uint16_t voltage) { return voltage * voltage_v; }
constexpr double celsius_from_temperature(std::uint8_t temperature) { return temperature * temperature_celsius; }

/// Protocol 1.0, MX-64: Current(68) [A].
constexpr double amperes_from_current1(std::uint16_t current) { return (current - 2048) * current1_a; }

/// What Baud Rate holds for a speed [bit/s]; none for speeds without a value of less than 3 % error.
constexpr std::optional<std::uint8_t> baud1_from_bits_per_s(std::uint32_t bits_per_s) {
  constexpr std::array<std::uint32_t, 3> fast{2'250'000, 2'500'000, 3'000'000};  // 250, 251, 252
  for (std::size_t i = 0; i < fast.size(); ++i) {
    if (fast[i] == bits_per_s) return static_cast<std::uint8_t>(250 + i);
  }
  if (bits_per_s < 7'900 || bits_per_s > 1'000'000) return std::nullopt;
  const std::uint32_t value = (2'000'000 + bits_per_s / 2) / bits_per_s - 1;  // speed = 2 Mbit/s / (value + 1)
  const double error = 2e6 / (value + 1) / bits_per_s - 1;
  if (value > 249 || error > 0.03 || error < -0.03) return std::nullopt;
  return static_cast<std::uint8_t>(value);
}
/// Of the values of Baud Rate, Protocol 2.0 [bit/s].
inline constexpr std::array<std::uint32_t, 8> baud2_rates{9'600,     57'600,    115'200,   1'000'000,
                                                          2'000'000, 3'000'000, 4'000'000, 4'500'000};
constexpr std::optional<std::uint8_t> baud2_from_bits_per_s(std::uint32_t bits_per_s) {
  for (std::size_t i = 0; i < baud2_rates.size(); ++i) {
    if (baud2_rates[i] == bits_per_s) return static_cast<std::uint8_t>(i);
  }
  return std::nullopt;
}

}  // namespace dynamixel
