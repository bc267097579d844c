// What a servo says of itself: which bytes to read, and what they mean.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "../bus/transport.hpp"
#include "../dynamixel/control_tables.hpp"
#include "../dynamixel/packet.hpp"

namespace dynamixel {

struct ServoState {
  double angle_rad = 0;  // from the centre of the turn
  double velocity_rad_per_s = 0;
  double current_a = std::numeric_limits<double>::quiet_NaN();  // where it is read
  double voltage_v = 0;                                         // 0 where it is not read
  double temperature_celsius = 0;                               // 0 where it is not read
};

/// How much is read in every cycle; health is voltage and temperature, everything has the current as well.
enum class FeedbackKind : std::uint8_t { motion, motion_and_health, everything, health };

class Feedback {
 public:
  /// `model` must outlive this.
  explicit Feedback(const ServoModel& model, FeedbackKind kind = FeedbackKind::motion_and_health)
      : model_(&model),
        position_(model.find("present_position")),
        velocity_(find(model, {"present_velocity", "present_speed"})),
        voltage_(find(model, {"present_input_voltage", "present_voltage"})),
        temperature_(model.find("present_temperature")),
        current_(model.find("present_current")) {
    if (kind != FeedbackKind::everything) current_ = nullptr;
    if (kind == FeedbackKind::motion) voltage_ = temperature_ = nullptr;
    if (kind == FeedbackKind::health) position_ = velocity_ = nullptr;
    std::size_t end = 0, begin = static_cast<std::size_t>(-1);
    for (const Register* r : {position_, velocity_, voltage_, temperature_, current_}) {
      if (r == nullptr) continue;
      begin = std::min<std::size_t>(begin, r->address);
      end = std::max(end, r->end());
    }
    address_ = static_cast<std::uint16_t>(begin);
    count_ = static_cast<std::uint16_t>(end - begin);
  }

  std::uint16_t address() const { return address_; }
  std::uint16_t count() const { return count_; }

  ServoState parse(Bytes bytes) const {
    ServoState state;
    if (position_ != nullptr) state.angle_rad = value(bytes, position_) - model_->center * model_->tick_rad;
    state.velocity_rad_per_s = value(bytes, velocity_);
    if (current_ != nullptr) state.current_a = value(bytes, current_);
    state.voltage_v = value(bytes, voltage_);
    state.temperature_celsius = value(bytes, temperature_);
    return state;
  }

 private:
  static const Register* find(const ServoModel& model, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) {
      if (const Register* found = model.find(name)) return found;
    }
    return nullptr;
  }

  double value(Bytes bytes, const Register* r) const {
    return r == nullptr ? 0 : value_from_bits(*r, bits_in(bytes, address_, *r));
  }

  const ServoModel* model_;
  const Register* position_;
  const Register* velocity_;
  const Register* voltage_;
  const Register* temperature_;
  const Register* current_;
  std::uint16_t address_ = 0;
  std::uint16_t count_ = 0;
};

}  // namespace dynamixel
