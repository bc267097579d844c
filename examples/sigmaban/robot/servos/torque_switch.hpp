// The torque of a group of servos, on and off, with the guard that watches it while it is on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "servo_registers.hpp"
#include "torque_guard.hpp"

namespace dynamixel {

/// `ServoBus` is a Bus. `guard` may be null; both must outlive this.
template <class ServoBus>
class TorqueSwitch {
 public:
  TorqueSwitch(ServoBus& bus, ServoRegisters<ServoBus>& registers, TorqueGuard* guard)
      : bus_(&bus), registers_(&registers), guard_(guard) {}

  /// From now on the torque may be on, and the guard watches.
  void on() {
    std::array<std::uint8_t, 512> packet;
    if (guard_ != nullptr) guard_->arm(registers_->torque_off_packet(packet));
    on_ = true;
  }

  /// Told three times, and again to those who say that theirs is on. Throws nothing.
  void off() noexcept {
    on_ = false;
    try {
      registers_->torque_off();
      sent_ = true;
      unconfirmed_ = registers_->confirm_torque_off(bus_->port().now() + from_seconds(confirm_s));
      if (guard_ != nullptr) guard_->disarm();
    } catch (...) {
      sent_ = false;  // the port is gone, and with it all that can be done here; an armed guard tries once more
      unconfirmed_ = registers_->ids().size();
    }
  }

  /// Leaves the torque as it is, for good: nothing switches it off any more, neither here nor in the servos.
  void leave() noexcept {
    on_ = false;
    try {
      for (int i = 0; i < 3; ++i) registers_->write_all("bus_watchdog", 0);
    } catch (...) {  // the port is gone
    }
    if (guard_ != nullptr) guard_->disarm();
  }

  /// The control loop lives.
  void beat() noexcept {
    if (guard_ != nullptr) guard_->beat();
  }
  bool guard_fired() const noexcept { return guard_ != nullptr && guard_->fired(); }

  bool is_on() const { return on_; }
  /// Could the last off() be sent?
  bool sent() const { return sent_; }
  /// Servos that did not say after the last off() that their torque is off.
  std::size_t unconfirmed() const { return unconfirmed_; }

 private:
  static constexpr double confirm_s = 0.1;  // for asking all whether their torque is off, at most [s]

  ServoBus* bus_;
  ServoRegisters<ServoBus>* registers_;
  TorqueGuard* guard_;
  bool on_ = false;
  bool sent_ = false;
  std::size_t unconfirmed_ = 0;
};

}  // namespace dynamixel
