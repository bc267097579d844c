// The backup file of surefoot-servos: all settings of servos as they were, and where to find the servos now.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../../../apps/common/files.hpp"
#include "servo_settings.hpp"

namespace dynamixel {

/// Of one servo, before and after.
struct ServoBackup {
  std::uint8_t id = 0, new_id = 0;
  std::uint16_t model_number = 0;
  RegisterValues registers;  // before, id and speed among them
};

struct SettingsBackup {
  int protocol = 2;
  std::uint32_t bits_per_s = 0, new_bits_per_s = 0;
  std::vector<ServoBackup> servos;
};

inline std::string to_json(const SettingsBackup& backup) {
  nlohmann::ordered_json json{{"schema", "surefoot.servos/1"},
                              {"protocol", backup.protocol},
                              {"bits_per_s", backup.bits_per_s},
                              {"new_bits_per_s", backup.new_bits_per_s},
                              {"servos", nlohmann::ordered_json::array()}};
  for (const ServoBackup& servo : backup.servos) {
    nlohmann::ordered_json registers;
    for (const auto& [name, counts] : servo.registers) registers[name] = counts;
    json["servos"].push_back({{"id", servo.id},
                              {"new_id", servo.new_id},
                              {"model", find_model(servo.model_number)->name},
                              {"model_number", servo.model_number},
                              {"registers", registers}});
  }
  return json.dump(1) + "\n";
}

/// Throws UsageError that names the file.
inline SettingsBackup read_backup(const std::filesystem::path& file) {
  const auto json = nlohmann::ordered_json::parse(example::read_text(file), nullptr, false);
  try {
    if (json.at("schema") != "surefoot.servos/1") throw example::UsageError("");
    SettingsBackup backup{json.at("protocol"), json.at("bits_per_s"), json.at("new_bits_per_s"), {}};
    for (const auto& entry : json.at("servos")) {
      ServoBackup servo{entry.at("id"), entry.at("new_id"), entry.at("model_number"), {}};
      if (find_model(servo.model_number) == nullptr) throw example::UsageError("");
      for (const auto& [name, counts] : entry.at("registers").items()) {
        servo.registers.emplace_back(name, counts.template get<std::uint32_t>());
      }
      backup.servos.push_back(std::move(servo));
    }
    if (backup.bits_per_s == 0 || backup.new_bits_per_s == 0) throw example::UsageError("");
    return backup;
  } catch (const std::exception&) {
    throw example::UsageError(file.string() + ": is no backup that surefoot-servos setup wrote");
  }
}

}  // namespace dynamixel
