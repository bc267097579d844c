// Torque, errors and settings of a servo: which bytes to read, and what they mean.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "../bus/protocols.hpp"
#include "../dynamixel/control_tables.hpp"
#include "../dynamixel/packet.hpp"
#include "servo_condition.hpp"

namespace dynamixel {

/// Registers next to each other that a servo forgets without power: gains, profiles, limits.
struct SettingsBlock {
  std::uint16_t address = 0;
  std::uint8_t count = 0;  // of bytes; 0: no such block
};

/// From the first of these registers that the model has to the end of the last one that it has.
constexpr SettingsBlock block_of(const ServoModel& model, std::initializer_list<std::string_view> first,
                                 std::initializer_list<std::string_view> last) {
  const auto found = [&](std::initializer_list<std::string_view> names) {
    const Register* result = nullptr;
    for (const std::string_view name : names) result = result != nullptr ? result : model.find(name);
    return result;
  };
  const Register *begin = found(first), *end = found(last);
  if (begin == nullptr || end == nullptr) return {};
  return {begin->address, static_cast<std::uint8_t>(end->end() - begin->address)};
}

/// What is to be put back after a reset: gains (of an AX-12 compliances), and profile, or speed and torque limit.
/// Goals, torque and watchdog are no settings.
constexpr std::array<SettingsBlock, 2> settings_of(const ServoModel& model) {
  return {block_of(model, {"velocity_i_gain", "d_gain", "cw_compliance_margin"},
                   {"feedforward_1st_gain", "p_gain", "ccw_compliance_slope"}),
          block_of(model, {"profile_acceleration", "moving_speed"}, {"profile_velocity", "torque_limit"})};
}

inline constexpr std::size_t settings_size = 24;  // of the blocks together, at most [bytes]
using Settings = std::array<std::uint8_t, settings_size>;

/// One read that tells whether a servo is as it was left.
class HealthRegisters {
 public:
  /// `model` must outlive this.
  explicit HealthRegisters(const ServoModel& model)
      : torque_(model.find("torque_enable")),
        error_(model.find("hardware_error_status")),
        watchdog_(model.find("bus_watchdog")),
        gains_(settings_of(model)[0]) {
    address_ = torque_->address;
    std::size_t end = std::max(torque_->end(), std::size_t{gains_.address} + gains_.count);
    for (const Register* r : {watchdog_, error_}) {
      if (r != nullptr) end = std::max(end, r->end());
    }
    count_ = static_cast<std::uint16_t>(end - address_);
  }

  std::uint16_t address() const { return address_; }
  std::uint16_t count() const { return count_; }

  /// `bytes` from address() on; `error_bits` of the status packet that brought them; settings and bus watchdog [counts]
  /// as they should be.
  Finding finding(Bytes bytes, std::uint8_t error_bits, const Settings& settings, std::uint32_t watchdog) const {
    const std::uint32_t error = hardware_error(bytes, error_bits);
    if ((error & protocol2::motor_encoder_error) != 0) return Finding::broken;
    constexpr std::uint32_t shut_down =
        protocol2::overheating_error | protocol2::electrical_shock_error | protocol2::overload_error;
    if ((error & shut_down) != 0) return Finding::shut_down;
    const bool kept = std::equal(settings.begin(), settings.begin() + gains_.count, bytes.begin() + at(gains_.address));
    const bool watched = watchdog_ == nullptr || bits_in(bytes, address_, *watchdog_) == watchdog;  // 255: has tripped
    return torque_on(bytes) && kept && watched ? Finding::fit : Finding::reset;
  }

  bool torque_on(Bytes bytes) const { return bits_in(bytes, address_, *torque_) != 0; }
  /// Stopped for want of instructions.
  bool watchdog_tripped(Bytes bytes) const {
    return watchdog_ != nullptr && bits_in(bytes, address_, *watchdog_) == 0xFF;
  }
  /// As Protocol 2.0 has the bits; of Protocol 1.0 overheating, overload and a wrong voltage are in each answer.
  std::uint32_t hardware_error(Bytes bytes, std::uint8_t error_bits) const {
    if (error_ != nullptr) return bits_in(bytes, address_, *error_);
    std::uint32_t bits = 0;
    if ((error_bits & protocol1::overheating_error) != 0) bits |= protocol2::overheating_error;
    if ((error_bits & protocol1::overload_error) != 0) bits |= protocol2::overload_error;
    if ((error_bits & protocol1::input_voltage_error) != 0) bits |= protocol2::input_voltage_error;
    return bits;
  }

 private:
  std::ptrdiff_t at(std::uint16_t address) const { return address - address_; }

  const Register* torque_;
  const Register* error_;     // null in Protocol 1.0
  const Register* watchdog_;  // null in Protocol 1.0
  SettingsBlock gains_;
  std::uint16_t address_ = 0;
  std::uint16_t count_ = 0;
};

}  // namespace dynamixel
