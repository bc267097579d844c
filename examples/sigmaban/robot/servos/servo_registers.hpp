// The registers of a group of servos, by name: written without waiting for answers, read back where it matters.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "../bus/bus.hpp"
#include "../dynamixel/control_tables.hpp"
#include "servo_health.hpp"

namespace dynamixel {

/// What a servo says of its health in one answer.
struct HealthAnswer {
  Finding finding = Finding::fit;
  bool watchdog_tripped = false;
  std::uint32_t hardware_error = 0;  // bits of protocol2::HardwareErrorBit
};

/// `ServoBus` is a Bus. Writes go out as sync writes, which no servo answers, so that servos of any Status Return Level
/// take them. Nothing is allocated after construction.
template <class ServoBus>
class ServoRegisters {
 public:
  /// `watchdog_s`: of the servos' own Bus Watchdog; 0: none [s].
  ServoRegisters(ServoBus& bus, const ServoModel& model, std::vector<std::uint8_t> ids, double watchdog_s)
      : bus_(&bus), model_(&model), health_(model), ids_(std::move(ids)), settings_(ids_.size()) {
    data_.reserve(4 * ids_.size());
    if (watchdog_s > 0) watchdog_ = static_cast<std::uint32_t>(std::clamp(watchdog_s / bus_watchdog_s, 1.0, 127.0));
  }

  std::span<const std::uint8_t> ids() const { return ids_; }
  bool has_watchdog() const { return watchdog_ > 0 && model_->find("bus_watchdog") != nullptr; }
  /// That of the servos' own Bus Watchdog while their torque is on [counts].
  std::uint32_t watchdog() const { return watchdog_; }

  /// The same value to all. Nothing where the model has no such register.
  void write_all(std::string_view name, std::uint32_t value) { write(name, ids_, value); }
  void write_one(std::size_t servo, std::string_view name, std::uint32_t value) {
    write(name, Bytes(ids_).subspan(servo, 1), value);
  }
  /// To each its own.
  void write_each(std::string_view name, std::span<const std::uint32_t> values) {
    const Register* r = model_->find(name);
    data_.clear();
    for (const std::uint32_t value : values) append(*r, value);
    bus_->sync_write(r->address, ids_, data_);
  }

  /// None if the servo does not tell.
  std::optional<std::uint32_t> read(std::size_t servo, std::string_view name, Time deadline = Time::max()) {
    const Register* r = model_->find(name);
    std::array<std::uint8_t, 4> bytes{};
    if (!bus_->read(ids_[servo], r->address, Buffer(bytes).first(r->size), deadline)) return std::nullopt;
    return bits_in(bytes, r->address, *r);
  }

  /// Remembers the settings as they should be. False if the servo does not tell them.
  bool keep_settings(std::size_t servo) {
    std::size_t done = 0;
    for (const SettingsBlock& block : settings_of(*model_)) {
      const Buffer bytes = Buffer(settings_[servo]).subspan(done, block.count);
      if (!bus_->read(ids_[servo], block.address, bytes)) return false;
      done += block.count;
    }
    return true;
  }
  void restore_settings(std::size_t servo) {
    std::size_t done = 0;
    for (const SettingsBlock& block : settings_of(*model_)) {
      bus_->sync_write(block.address, Bytes(ids_).subspan(servo, 1),
                       Bytes(settings_[servo]).subspan(done, block.count));
      done += block.count;
    }
  }

  /// None if the servo does not answer before the deadline.
  std::optional<HealthAnswer> read_health(std::size_t servo, Time deadline = Time::max()) {
    std::array<std::uint8_t, 64> bytes{};
    const Buffer read = Buffer(bytes).first(health_.count());
    const Reply reply = bus_->read(ids_[servo], health_.address(), read, deadline);
    if (!reply) return std::nullopt;
    return HealthAnswer{health_.finding(read, reply.error_bits, settings_[servo], watchdog_),
                        health_.watchdog_tripped(read), health_.hardware_error(read, reply.error_bits)};
  }

  /// Torque off and bus watchdog off, told three times.
  void torque_off() {
    for (int i = 0; i < 3; ++i) write_all("torque_enable", 0);
    for (int i = 0; i < 3; ++i) write_all("bus_watchdog", 0);
  }

  /// Asks each whether its torque is off, and tells all again where one says it is not. Returns how many have not said
  /// that it is off when time is over or those left never answer.
  std::size_t confirm_torque_off(Time deadline) {
    std::array<bool, max_servos> off{};
    std::size_t open = ids_.size();
    for (int round = 0; round < most_rounds && open > 0 && bus_->port().now() < deadline; ++round) {
      bool any_on = false;
      for (std::size_t i = 0; i < ids_.size() && bus_->port().now() < deadline; ++i) {
        if (off[i]) continue;
        const auto torque = read(i, "torque_enable", deadline);
        off[i] = torque == 0U;
        open -= off[i] ? 1U : 0U;
        any_on = any_on || (torque && *torque != 0);
      }
      if (any_on) round = 0;
      write_all("torque_enable", 0);
    }
    return open;
  }

  /// The instruction that switches the torque of all off, as bytes for the line.
  Bytes torque_off_packet(Buffer out) const {
    const std::array<std::uint8_t, max_servos> zeros{};
    const std::uint16_t address = model_->find("torque_enable")->address;
    return ServoBus::Wire::sync_write(out, address, 1, ids_, Bytes(zeros).first(ids_.size()));
  }

 private:
  static constexpr int most_rounds = 6;  // a servo that has not answered by then does not

  void append(const Register& r, std::uint32_t value) {
    for (unsigned byte = 0; byte < r.size; ++byte) data_.push_back(static_cast<std::uint8_t>(value >> (8 * byte)));
  }
  void write(std::string_view name, Bytes ids, std::uint32_t value) {
    const Register* r = model_->find(name);
    if (r == nullptr) return;
    data_.clear();
    for (std::size_t i = 0; i < ids.size(); ++i) append(*r, value);
    bus_->sync_write(r->address, ids, data_);
  }

  ServoBus* bus_;
  const ServoModel* model_;
  HealthRegisters health_;
  std::vector<std::uint8_t> ids_;
  std::vector<Settings> settings_;
  std::vector<std::uint8_t> data_;
  std::uint32_t watchdog_ = 0;  // [counts]
};

}  // namespace dynamixel
