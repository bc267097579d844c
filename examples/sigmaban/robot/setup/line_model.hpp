// What the servos on a line have in common, for programs that drive all of them alike.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "../servos/alarms.hpp"
#include "../servos/feedback.hpp"
#include "../servos/joint.hpp"
#include "../servos/servo_health.hpp"
#include "servo_settings.hpp"

namespace dynamixel {

struct LineModel {
  const ServoModel* model = nullptr;                        // of one of them
  AlarmOptions alarms{};                                    // the narrowest of all
  FeedbackKind feedback = FeedbackKind::motion_and_health;  // with the currents where all have the same
};

/// Do they have all that a walk needs in the same places, and count angles alike?
inline bool driven_alike(const ServoModel& a, const ServoModel& b) {
  const auto same = [&](std::string_view name) {
    const Register *one = a.find(name), *other = b.find(name);
    if (one == nullptr || other == nullptr) return one == other;
    return one->address == other->address && one->size == other->size;
  };
  constexpr std::array<std::string_view, 6> needed{"goal_position",     "present_position",      "torque_enable",
                                                   "return_delay_time", "hardware_error_status", "bus_watchdog"};
  const Feedback mine(a), others(b);
  const auto blocks = settings_of(a), other_blocks = settings_of(b);
  return a.protocol == b.protocol && a.center == b.center && a.tick_rad == b.tick_rad &&
         std::ranges::all_of(needed, same) && mine.address() == others.address() && mine.count() == others.count() &&
         std::ranges::equal(blocks, other_blocks, {}, &SettingsBlock::address, &SettingsBlock::address);
}

/// Do they tell their current next to the rest, in the same place and unit?
inline bool current_alike(const ServoModel& a, const ServoModel& b) {
  const Register *one = a.find("present_current"), *other = b.find("present_current");
  return one != nullptr && other != nullptr && one->address == other->address && one->factor == other->factor;
}

/// Of the servos of these joints, as they say; `usual` where none of them answers. Reads end where the shortest of
/// their control tables does. Throws BusError for servos that are not known, and for those that cannot be driven alike.
template <class ServoBus>
LineModel line_model(ServoBus& bus, const std::vector<Joint>& joints, const ServoModel& usual) {
  constexpr double wait_s = 0.2;  // what is wrong with one that does not answer is said at the start of the group [s]
  LineModel line{&usual, alarms_of(usual)};
  std::size_t heard = 0, end = usual.registers.back().end();
  for (const Joint& joint : joints) {
    const ServoModel* model = model_of(bus, joint.id, wait_s);
    if (model == nullptr) break;
    const AlarmOptions alarms = alarms_of(*model);
    if (heard++ == 0) {
      line = {model, alarms};
      end = model->registers.back().end();
      line.feedback = FeedbackKind::everything;
    }
    if (!current_alike(*line.model, *model)) line.feedback = FeedbackKind::motion_and_health;
    if (!driven_alike(*line.model, *model)) {
      throw BusError("joint " + joint.name + " (servo " + std::to_string(joint.id) + "): is of the model " +
                     std::string(model->name) + ", which cannot be driven together with " +
                     std::string(line.model->name) + " of joint " + joints.front().name +
                     "; give each of them a port of its own (surefoot-walk joints)");
    }
    end = std::min(end, model->registers.back().end());
    line.alarms.low_voltage_v = std::max(line.alarms.low_voltage_v, alarms.low_voltage_v);
    line.alarms.high_voltage_v = std::min(line.alarms.high_voltage_v, alarms.high_voltage_v);
    line.alarms.hot_celsius = std::min(line.alarms.hot_celsius, alarms.hot_celsius);
    line.alarms.cool_celsius = std::min(line.alarms.cool_celsius, alarms.cool_celsius);
  }
  bus.set_table_end(static_cast<std::uint16_t>(end));
  return line;
}

}  // namespace dynamixel
