// The settings of one servo: which registers are settings, read, written and read back.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../bus/bus.hpp"
#include "../bus/keep_trying.hpp"
#include "../dynamixel/servo_models.hpp"

namespace dynamixel {

/// Name and counts, in the order of the control table.
using RegisterValues = std::vector<std::pair<std::string, std::uint32_t>>;

/// Does it say how the servo works? Not what it is to do now, nor where data are shown again.
inline bool is_setting(const Register& r) {
  if (r.access == Access::read_only || r.repeats > 1) return false;
  for (const std::string_view now :
       {"torque_enable", "led", "bus_watchdog", "lock", "current", "torque_ctrl_mode_enable"}) {
    if (r.name == now) return false;
  }
  return !r.name.starts_with("goal_") && !r.name.starts_with("external_port_data");
}

/// For which an answer is waited for: nothing is moving, so that a computer may stand still for a while [s].
inline constexpr double patience_s = 1;

/// Bytes that may be read of any servo: no control table is shorter than that of the AX-12, 50 bytes.
inline constexpr std::uint16_t every_table = 50;

/// In the way of a servo that is only being set up: slow, but sure.
template <class ServoBus>
class ServoSettings {
 public:
  /// All must outlive this.
  ServoSettings(ServoBus& bus, const ServoModel& model, std::uint8_t id) : bus_(&bus), model_(&model), id_(id) {
    bus.set_table_end(static_cast<std::uint16_t>(model.registers.back().end()));
  }

  std::uint8_t id() const { return id_; }
  const ServoModel& model() const { return *model_; }

  /// Throws BusError where the servo does not tell.
  std::uint32_t read(const Register& r) {
    std::array<std::uint8_t, 4> bytes{};
    const auto told = [&] { return bool(bus_->read(id_, r.address, Buffer(bytes).first(r.size))); };
    if (keep_trying(*bus_, patience_s, told)) return bits_in(bytes, r.address, r);
    fail("does not tell its " + std::string(r.name));
  }

  RegisterValues read_all() {
    RegisterValues values;
    for (const Register& r : model_->registers) {
      if (is_setting(r)) values.emplace_back(r.name, read(r));
    }
    return values;
  }

  /// Of a register of that name. Throws BusError where the model has none, or the servo does not take it.
  void write(std::string_view name, std::uint32_t counts) {
    const Register& r = at(name);
    if (r.access == Access::read_only) fail("only tells its " + std::string(name) + ", which cannot be set");
    for (int i = 0; i < least_tries; ++i) {
      send(r, counts);
      if (read(r) == counts) return;
    }
    fail("does not take " + std::to_string(counts) + " as its " + std::string(name) + "; see its range");
  }

  /// By an instruction that nobody answers, without looking: for id and speed, after which it is elsewhere.
  void send(const Register& r, std::uint32_t counts) {
    std::array<std::uint8_t, 4> bytes{};
    for (unsigned i = 0; i < r.size; ++i) bytes[i] = static_cast<std::uint8_t>(counts >> (8 * i));
    bus_->sync_write(r.address, Bytes(&id_, 1), Bytes(bytes).first(r.size));
  }

  /// Registers of the EEPROM can be written only then.
  void torque_off() { write("torque_enable", 0); }

  const Register& at(std::string_view name) const {
    const Register* r = model_->find(name);
    if (r == nullptr) fail("has no register " + std::string(name));
    return *r;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BusError("servo " + std::to_string(id_) + " (" + std::string(model_->name) + ") " + what);
  }

 private:
  ServoBus* bus_;
  const ServoModel* model_;
  std::uint8_t id_;
};

/// The model of the servo with that id; none where nobody answers for that long [s]. Throws BusError for one that is
/// not known.
template <class ServoBus>
const ServoModel* model_of(ServoBus& bus, std::uint8_t id, double wait_s = patience_s) {
  bus.set_table_end(every_table);
  std::array<std::uint8_t, 2> bytes{};
  if (!keep_trying(bus, wait_s, [&] { return bool(bus.read(id, 0, bytes)); })) return nullptr;
  const unsigned number = bytes[0] + 256U * bytes[1];
  const ServoModel* model = find_model(number);
  if (model == nullptr) {
    throw BusError("servo " + std::to_string(id) + " has the model number " + std::to_string(number) +
                   ", which is not known here");
  }
  return model;
}

}  // namespace dynamixel
