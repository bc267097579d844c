// The care for the servos of a group, done: their health asked for, their settings and torque given back.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "servo_care.hpp"
#include "servo_events.hpp"
#include "servo_registers.hpp"

namespace dynamixel {

/// `ServoBus` is a Bus. Nothing is allocated after construction.
template <class ServoBus>
class ServoKeeper {
 public:
  ServoKeeper(ServoRegisters<ServoBus>& registers, std::size_t joints, const CareOptions& options)
      : registers_(&registers), care_(joints, options), torque_due_(joints) {}

  ServoCare& care() { return care_; }
  const ServoCare& care() const { return care_; }

  void begin() {
    care_.begin();
    std::fill(torque_due_.begin(), torque_due_.end(), char{0});
  }

  /// None if the servo does not answer before the deadline.
  std::optional<Finding> ask(std::size_t i, Time deadline) {
    const auto health = registers_->read_health(i, deadline);
    if (!health) return std::nullopt;
    if (health->watchdog_tripped) registers_->write_one(i, "bus_watchdog", 0);  // else it takes no goals
    return health->finding;
  }

  /// Takes a finding. Where that asks to restore the servo, it has its settings now, and gets its torque with the next
  /// send_torque(), before which its goal must be where it is.
  Reaction take(std::size_t i, Finding finding, ServoEvents& events) {
    const Condition before = care_.condition(i);
    const Reaction reaction = care_.take(i, finding);
    const Condition now = care_.condition(i);
    if (reaction == Reaction::restore) {
      registers_->write_one(i, "bus_watchdog", registers_->watchdog());
      registers_->restore_settings(i);
      torque_due_[i] = true;
      if (before != Condition::restoring) events.note({ServoEventKind::reset, i});
    }
    if (before == Condition::restoring && now == Condition::working) events.note({ServoEventKind::restored, i});
    if (before != Condition::failed && now == Condition::failed) events.note({ServoEventKind::failed, i});
    return reaction;
  }

  void send_torque() {
    for (std::size_t i = 0; i < torque_due_.size(); ++i) {
      if (std::exchange(torque_due_[i], false) == 0) continue;
      registers_->write_one(i, "torque_enable", 1);
      registers_->write_one(i, "bus_watchdog", registers_->watchdog());
    }
  }

 private:
  ServoRegisters<ServoBus>* registers_;
  ServoCare care_;
  std::vector<char> torque_due_;  // was restored: gets its torque with the next goals
};

}  // namespace dynamixel
