// Settings of servos changed, with a backup first, and put back from it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "servo_line.hpp"
#include "settings_backup.hpp"

namespace dynamixel {

/// What is to become of each of some servos; what is empty stays as it is.
struct SettingsChange {
  std::optional<std::uint8_t> new_id = {};  // for a single servo
  std::optional<std::uint32_t> new_bits_per_s = {};
  std::optional<double> return_delay_s = {};
  bool zero_here = false;                                     // each is where it should count as straight
  std::vector<std::pair<std::string, double>> settings = {};  // by name, in the unit of the register
};

namespace change_detail {

template <class ServoBus>
std::uint32_t counts_of(const ServoSettings<ServoBus>& servo, const std::string& name, double value) {
  const Register& r = servo.at(name);
  const auto counts = bits_from_value(r, value);
  if (!counts || !is_setting(r)) servo.fail("cannot have " + std::to_string(value) + " as its " + name);
  return *counts;
}

/// Such that the present position becomes the centre. Protocol 2.0; others have no such register.
template <class ServoBus>
std::uint32_t offset_for_zero_here(ServoSettings<ServoBus>& servo) {
  const ServoModel& model = servo.model();
  if (model.find("homing_offset") == nullptr) {
    servo.fail("has no Homing Offset; give its zero_rad to surefoot-walk --joints instead");
  }
  const auto position = static_cast<std::int32_t>(servo.read(servo.at("present_position")));
  const auto before = static_cast<std::int32_t>(servo.read(servo.at("homing_offset")));
  const int offset = before + model.center - position;
  constexpr int most = 1024;  // more has no effect in position control (e-Manual, Homing Offset)
  if (std::abs(offset) > most) servo.fail("is more than 90 degrees from its centre; mount its horn anew");
  return static_cast<std::uint32_t>(offset);
}

/// Counts by register, computed before anything is written.
template <class ServoBus>
RegisterValues planned(ServoSettings<ServoBus>& servo, const SettingsChange& change) {
  RegisterValues values;
  if (change.return_delay_s) {
    values.emplace_back("return_delay_time", counts_of(servo, "return_delay_time", *change.return_delay_s));
  }
  if (change.zero_here) values.emplace_back("homing_offset", offset_for_zero_here(servo));
  for (const auto& [name, value] : change.settings) values.emplace_back(name, counts_of(servo, name, value));
  return values;
}

/// Of Baud Rate. Throws BusError where the model cannot do that speed.
template <class ServoBus>
std::uint32_t baud_rate_for(const ServoSettings<ServoBus>& servo, std::uint32_t bits_per_s) {
  const auto value = baud_rate_of(servo.model(), bits_per_s);
  if (!value) servo.fail("cannot do " + std::to_string(bits_per_s) + " bit/s");
  return *value;
}

template <class ServoBus>
const ServoModel& known_model(ServoBus& bus, std::uint8_t id) {
  const ServoModel* model = model_of(bus, id);
  if (model == nullptr) throw BusError("servo " + std::to_string(id) + " does not answer");
  return *model;
}

/// Of a register after which the servo is elsewhere: until it is silent where it was. Nobody confirms it.
template <class ServoBus>
void send_away(ServoBus& bus, ServoSettings<ServoBus>& servo, const char* name, std::uint32_t counts) {
  constexpr int most = 10, sure = 2;  // one answer may be lost by chance
  std::array<std::uint8_t, 2> number{};
  for (int i = 0, silent = 0; i < most && silent < sure; ++i) {
    servo.send(servo.at(name), counts);
    silent = bus.read(servo.id(), 0, number) ? 0 : silent + 1;
  }
}

}  // namespace change_detail

/// Everything is planned and the backup written before anything changes. Throws BusError, with what was done until
/// then in the servos; the backup undoes it.
template <class Protocol>
void change_settings(const ServoLine& line, const std::vector<std::uint8_t>& ids, const SettingsChange& change,
                     const std::filesystem::path& backup_file) {
  using namespace change_detail;
  SettingsBackup backup{line.protocol, line.bits_per_s, change.new_bits_per_s.value_or(line.bits_per_s), {}};
  {
    auto bus = open_patiently<Protocol>(line.port, line.bits_per_s);
    if (change.new_id && *change.new_id != ids.front() && bus.ping(*change.new_id)) {
      throw BusError("servo " + std::to_string(*change.new_id) + " is there already, give another --new-id");
    }
    std::vector<RegisterValues> plans;
    std::vector<const ServoModel*> models;
    for (const std::uint8_t id : ids) {
      models.push_back(&known_model(bus, id));
      ServoSettings<PatientBus<Protocol>> servo(bus, *models.back(), id);
      plans.push_back(planned(servo, change));
      if (change.new_bits_per_s) static_cast<void>(baud_rate_for(servo, *change.new_bits_per_s));
      backup.servos.push_back({id, change.new_id.value_or(id), models.back()->model_number, servo.read_all()});
    }
    example::write_text(backup_file, to_json(backup));
    for (std::size_t i = 0; i < ids.size(); ++i) {
      ServoSettings<PatientBus<Protocol>> servo(bus, *models[i], ids[i]);
      servo.torque_off();
      for (const auto& [name, counts] : plans[i]) servo.write(name, counts);
    }
    for (std::size_t i = 0; i < ids.size(); ++i) {
      ServoSettings<PatientBus<Protocol>> servo(bus, *models[i], ids[i]);
      if (change.new_bits_per_s && *change.new_bits_per_s != line.bits_per_s) {
        send_away(bus, servo, "baud_rate", baud_rate_for(servo, *change.new_bits_per_s));
      }
    }
  }
  auto bus = open_patiently<Protocol>(line.port, backup.new_bits_per_s);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const ServoModel& model = known_model(bus, ids[i]);
    if (!change.new_id || *change.new_id == ids[i]) continue;
    ServoSettings<PatientBus<Protocol>> servo(bus, model, ids[i]);
    send_away(bus, servo, "id", *change.new_id);
    static_cast<void>(known_model(bus, *change.new_id));
  }
}

namespace change_detail {

/// Where it is now, by that id, gets its settings back, then its id and its speed.
template <class ServoBus>
void restore_servo(ServoBus& bus, const ServoModel& model, std::uint8_t id, const ServoBackup& saved,
                   bool other_speed) {
  ServoSettings<ServoBus> servo(bus, model, id);
  servo.torque_off();
  std::uint32_t baud_rate = 0;
  for (const auto& [name, counts] : saved.registers) {
    if (name == "baud_rate") baud_rate = counts;
    if (name != "id" && name != "baud_rate") servo.write(name, counts);
  }
  if (id != saved.id) send_away(bus, servo, "id", saved.id);
  ServoSettings<ServoBus> back(bus, known_model(bus, saved.id), saved.id);
  if (other_speed) send_away(bus, back, "baud_rate", baud_rate);
}

/// Those of the backup that answer at that speed and are not `done` yet.
template <class Protocol>
void restore_at(const std::string& port, std::uint32_t speed, const SettingsBackup& backup, std::vector<bool>& done) {
  auto bus = open_patiently<Protocol>(port, speed);
  for (std::size_t i = 0; i < backup.servos.size(); ++i) {
    const ServoBackup& saved = backup.servos[i];
    const std::uint8_t ids[] = {saved.new_id, saved.id};
    for (const std::uint8_t id : std::span(ids).first(saved.new_id == saved.id ? 1 : 2)) {
      constexpr double glance_s = 0;  // it may well be elsewhere
      const ServoModel* model = done[i] ? nullptr : model_of(bus, id, glance_s);
      if (model == nullptr || model->model_number != saved.model_number) continue;
      restore_servo(bus, *model, id, saved, speed != backup.bits_per_s);
      done[i] = true;
    }
  }
}

}  // namespace change_detail

/// Puts all settings back, wherever the servos are: before the change, after it, or between. Throws BusError, naming
/// the servo, where one is not found or does not take a setting.
template <class Protocol>
void restore_settings(const std::string& port, const SettingsBackup& backup) {
  using namespace change_detail;
  std::vector<bool> done(backup.servos.size());
  constexpr int passes = 3;  // over both speeds: answers may be lost
  for (int pass = 0; pass < passes && std::ranges::find(done, false) != done.end(); ++pass) {
    restore_at<Protocol>(port, backup.new_bits_per_s, backup, done);
    if (backup.bits_per_s != backup.new_bits_per_s) restore_at<Protocol>(port, backup.bits_per_s, backup, done);
  }
  auto bus = open_patiently<Protocol>(port, backup.bits_per_s);
  for (const ServoBackup& saved : backup.servos) {
    ServoSettings<PatientBus<Protocol>> servo(bus, known_model(bus, saved.id), saved.id);
    if (servo.read_all() != saved.registers) servo.fail("is not as it was; run restore again");
  }
}

/// Until it answers again. Throws BusError, naming the servo, where it does not.
template <class ServoBus>
void reboot_servo(ServoBus& bus, std::uint8_t id) {
  const ServoModel& model = change_detail::known_model(bus, id);
  ServoSettings<ServoBus> servo(bus, model, id);
  if (!keep_trying(bus, patience_s, [&] { return bool(bus.reboot(id)); })) {
    servo.fail("does not take the instruction to start anew; switch its power off and on");
  }
  static_cast<void>(change_detail::known_model(bus, id));
}

}  // namespace dynamixel
