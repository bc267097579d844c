// One servo: its registers, its motor, and how the two act on each other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "../bus/protocols.hpp"
#include "../bus/transport.hpp"
#include "../dynamixel/servo_models.hpp"
#include "servo_motor.hpp"
#include "virtual_servo_registers.hpp"

namespace dynamixel {

/// Why a servo refuses.
enum class Refusal : std::uint8_t { none, range, limit, access };

/// Registers hold what the e-Manual gives for a new servo where that matters here, but answers come without delay.
/// Overheating switches the torque off until it is switched on again cooler; what shut_down() does stays until it is
/// rebooted. A bus watchdog that has tripped holds the motor where it is, torque on, and refuses goals until it is set
/// to 0: so does the real one in position control.
class VirtualServo {
 public:
  /// `angle_rad` is where it is at first, from a straight joint.
  VirtualServo(const ServoModel& model, std::uint8_t id, double angle_rad = 0, const MotorParameters& motor = {})
      : model_(&model), known_(model), motor_(motor) {
    state_.position_rad = angle_rad;
    voltage_v = model.factory.supply_v;
    set("model_number", model.model_number);
    set("firmware_version", model.protocol == 1 ? 41 : 43);
    set("id", id);
    set("return_delay_time", 0);
    set("status_return_level", 2);
    set("baud_rate", model.factory.baud_rate);
    set("temperature_limit", model.factory.temperature_limit);
    set("min_voltage_limit", model.factory.min_voltage_limit);
    set("max_voltage_limit", model.factory.max_voltage_limit);
    set("max_torque", 1023);
    set("torque_limit", 1023);
    set("pwm_limit", 885);
    set("p_gain", model.factory.p_gain);
    set("position_p_gain", model.factory.p_gain);
    set("ccw_angle_limit", 2 * model.center - 1);
    set("max_position_limit", 2 * model.center - 1);
    set("goal_position", ticks());
    show();
    as_new_ = bytes_;
  }

  std::uint8_t id() const { return static_cast<std::uint8_t>(value(known_.id)); }
  const MotorState& state() const { return state_; }

  double voltage_v = 12.0;  // at first what its model is made for
  double temperature_celsius = 35.0;
  double load_nm = 0;       // torque on the shaft [N m]
  double load_inertia = 0;  // of what hangs on it [kg m^2]
  bool deaf = false;        // its cable is cut: it hears nothing and says nothing

  static constexpr double starts_within_s = 0.3;  // after a reboot, until it hears and answers [s]
  /// Below it the servo's own computer stops [V].
  double least_supply_v() const { return std::min(6.5, model_->factory.min_voltage_limit * dynamixel::voltage_v); }

  /// As after a moment without power: no torque, no errors, registers of the RAM as new, silent until it has started.
  void reboot(Time now) {
    const auto ram = static_cast<std::ptrdiff_t>(model_->first_ram_address);
    std::copy(as_new_.begin() + ram, as_new_.end(), bytes_.begin() + ram);
    latched_errors_ = 0;
    stored_size_ = 0;
    starts_at_ = now + from_seconds(starts_within_s);
    set(known_.goal_position, ticks());
    show();
  }
  /// `errors`: bits of protocol2::HardwareErrorBit. Torque off, until a reboot.
  void shut_down(unsigned errors) {
    latched_errors_ |= errors;
    set(known_.torque_enable, 0);
    if (model_->protocol == 1) set(known_.torque_limit, 0);
    show();
  }
  bool hears(Time now) const { return !deaf && now >= starts_at_ && voltage_v >= least_supply_v(); }
  bool torque_on() const { return value(known_.torque_enable) != 0; }
  bool watchdog_tripped() const { return watchdog() < 0; }
  /// A device without that register answers all.
  int status_return_level() const {
    return known_.status_return_level != nullptr ? static_cast<int>(value(known_.status_return_level)) : 2;
  }
  /// An instruction came, to it or to others.
  void note_instruction(Time now) { last_instruction_ = now; }

  /// Moves the motor to `now`, in steps of 1 ms, and shows it in the registers. More than a second is skipped.
  void advance(Time now) {
    constexpr Time step_time = std::chrono::milliseconds(1);
    if (now - moved_to_ > std::chrono::seconds(1)) moved_to_ = now - step_time;
    if (now - moved_to_ < step_time) return;
    if (voltage_v < least_supply_v()) reboot(now);
    if (overheated()) set(known_.torque_enable, 0);
    look_at_watchdog(now);
    const MotorInputs inputs{
        torque_on(),
        goal_rad(),
        p_gain(),
        voltage_v,
        load_nm,
        load_inertia,
        known_.pwm_limit != nullptr ? value(known_.pwm_limit) / 885.0 : value(known_.torque_limit) / 1023.0};
    for (; now - moved_to_ >= step_time; moved_to_ += step_time) state_ = step(motor_, state_, inputs, 1e-3);
    show();
  }

  Refusal read(std::size_t address, Buffer out) const {
    if (address + out.size() > bytes_.size()) return Refusal::range;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(address), out.size(), out.begin());
    return Refusal::none;
  }

  /// All or nothing.
  Refusal write(std::size_t address, Bytes data) {
    if (data.empty() || address + data.size() > bytes_.size()) return Refusal::range;
    const bool locked = torque_on() && address < model_->first_ram_address;
    if (locked) return Refusal::access;
    if (latched_errors_ != 0 && address == known_.torque_enable->address && data[0] != 0) return Refusal::access;
    auto changed = bytes_;
    std::copy(data.begin(), data.end(), changed.begin() + static_cast<std::ptrdiff_t>(address));
    for (const Register& r : model_->registers) {
      const bool touched = r.address < address + data.size() && address < r.end();
      if (touched && r.access == Access::read_only) return Refusal::access;
      if (touched && r.name.starts_with("goal_") && watchdog_tripped()) return Refusal::limit;
      if (touched && r.name == "goal_position" && beyond_limits(bits_in(changed, 0, r))) return Refusal::limit;
    }
    bytes_ = changed;
    return Refusal::none;
  }

  /// Keeps a write until the action. One at a time; longer ones than 16 bytes are refused.
  Refusal store(std::size_t address, Bytes data) {
    if (data.empty() || data.size() > stored_.size()) return Refusal::range;
    std::copy(data.begin(), data.end(), stored_.begin());
    stored_address_ = address;
    stored_size_ = data.size();
    set(known_.registered, 1);
    return Refusal::none;
  }
  void act() {
    if (stored_size_ == 0) return;
    static_cast<void>(write(stored_address_, Bytes(stored_).first(stored_size_)));
    stored_size_ = 0;
    set(known_.registered, 0);
  }

  bool overheated() const {
    return known_.temperature_limit != nullptr && temperature_celsius > value(known_.temperature_limit);
  }
  bool voltage_is_wrong() const {
    if (known_.min_voltage_limit == nullptr) return false;
    const double counts = voltage_v / 0.1;
    return counts < value(known_.min_voltage_limit) || counts > value(known_.max_voltage_limit);
  }

  /// As in a status packet of the model's protocol.
  std::uint8_t error_bits(Refusal refusal) const {
    unsigned bits = 0;
    if (model_->protocol == 1) {
      if (voltage_is_wrong()) bits |= protocol1::input_voltage_error;
      if ((hardware_errors() & protocol2::overheating_error) != 0) bits |= protocol1::overheating_error;
      if ((hardware_errors() & protocol2::overload_error) != 0) bits |= protocol1::overload_error;
      if (refusal == Refusal::limit) bits |= protocol1::angle_limit_error;
      if (refusal == Refusal::range || refusal == Refusal::access) bits |= protocol1::range_error;
    } else {
      if (hardware_errors() != 0) bits |= protocol2::alert_bit;
      constexpr protocol2::Error errors[] = {protocol2::Error::none, protocol2::Error::data_length,
                                             protocol2::Error::data_range, protocol2::Error::access};
      bits |= static_cast<unsigned>(errors[static_cast<std::size_t>(refusal)]);
    }
    return static_cast<std::uint8_t>(bits);
  }

  /// Of its Baud Rate [bit/s].
  std::uint32_t bits_per_s() const {
    return bits_per_s_of(*model_, static_cast<unsigned>(value(known_.baud_rate))).value_or(0);
  }
  const ServoModel& model() const { return *model_; }
  double return_delay() const { return value(known_.return_delay_time) * return_delay_s; }  // [s]
  /// Without effect where the model has no such register.
  void set(std::string_view name, std::int64_t bits) { set(model_->find(name), bits); }

 private:
  using Table = std::array<std::uint8_t, 768>;

  unsigned hardware_errors() const {
    unsigned bits = latched_errors_;
    if (voltage_is_wrong()) bits |= protocol2::input_voltage_error;
    if (overheated()) bits |= protocol2::overheating_error;
    return bits;
  }

  /// In counts; -1 where it has tripped.
  int watchdog() const { return static_cast<std::int8_t>(static_cast<std::uint8_t>(value(known_.bus_watchdog))); }
  void look_at_watchdog(Time now) {
    if (!torque_on() || watchdog() <= 0 || now - last_instruction_ <= from_seconds(watchdog() * bus_watchdog_s)) return;
    set(known_.bus_watchdog, 0xFF);
    set(known_.goal_position, ticks());
  }

  /// 0 where the model has no such register.
  double value(const Register* r) const { return r != nullptr ? bits_in(bytes_, 0, *r) : 0; }
  void set(const Register* r, std::int64_t bits) {
    for (std::size_t i = 0; r != nullptr && i < r->size; ++i) {
      bytes_[r->address + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(bits) >> (8 * i));
    }
  }

  bool beyond_limits(std::uint32_t goal) const {
    const bool angles = known_.cw_angle_limit != nullptr;
    const double low = value(angles ? known_.cw_angle_limit : known_.min_position_limit);
    const double high = value(angles ? known_.ccw_angle_limit : known_.max_position_limit);
    const double ticks = static_cast<std::int32_t>(goal);
    return ticks < low || ticks > high;
  }

  std::int64_t ticks() const { return std::lround(state_.position_rad / model_->tick_rad) + model_->center; }
  double goal_rad() const {
    return (static_cast<std::int32_t>(value(known_.goal_position)) - model_->center) * model_->tick_rad;
  }
  /// In counts of Protocol 1.0, whose law has a factor of 1/8 where 2.0 has 1/128 on other units: 850 is like 32. AX-12
  /// has no gain but compliances.
  double p_gain() const {
    if (known_.position_p_gain != nullptr) return value(known_.position_p_gain) * 32.0 / 850.0;
    return known_.p_gain != nullptr ? value(known_.p_gain) : 32.0;
  }

  void show() {
    const auto counts = [](double share) { return std::lround(share); };
    const double speed = state_.velocity_rad_per_s;
    set(known_.present_position, ticks());
    set(known_.present_velocity, counts(speed / velocity2_rad_per_s));
    const long speed1 = std::min(1023L, counts(std::abs(speed) / speed1_rad_per_s));
    set(known_.present_speed, speed < 0 ? 0x400 | speed1 : speed1);
    set(known_.position_trajectory, static_cast<std::int64_t>(value(known_.goal_position)));
    if (known_.present_current != nullptr) {
      set(known_.present_current, counts(state_.current_a / known_.present_current->factor));
    }
    set(known_.current, 2048 + counts(state_.current_a / current1_a));
    set(known_.present_voltage, counts(voltage_v / 0.1));
    set(known_.present_input_voltage, counts(voltage_v / 0.1));
    set(known_.present_temperature, counts(temperature_celsius));
    set(known_.hardware_error_status, hardware_errors());
    set(known_.realtime_tick, (moved_to_.count() / 1'000'000) % 32768);
  }

  const ServoModel* model_;
  VirtualServoRegisters known_;
  MotorParameters motor_;
  MotorState state_;
  Table bytes_{};
  Table as_new_{};
  unsigned latched_errors_ = 0;
  Time moved_to_{Time::min() / 2};
  Time starts_at_{Time::min()};
  Time last_instruction_{Time::min() / 2};
  std::array<std::uint8_t, 16> stored_{};
  std::size_t stored_address_ = 0;
  std::size_t stored_size_ = 0;
};

}  // namespace dynamixel
