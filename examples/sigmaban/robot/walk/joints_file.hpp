// Which servo moves which joint: a JSON file, for robots whose servos are not numbered 1 to 12 from zero.
#pragma once

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../../../apps/common/files.hpp"
#include "../servos/joint.hpp"
#include "../walk_engine/joint_targets.hpp"

namespace sigmaban {

/// Servo 1 is the first of joint_names and so on; each at its centre where the leg is straight.
inline std::vector<dynamixel::Joint> default_joints() {
  std::vector<dynamixel::Joint> joints;
  for (const std::string_view name : joint_names) {
    joints.push_back({.name = std::string(name), .id = static_cast<std::uint8_t>(joints.size() + 1)});
  }
  return joints;
}

inline std::string joints_to_json(const std::vector<dynamixel::Joint>& joints) {
  nlohmann::ordered_json json;
  for (const dynamixel::Joint& joint : joints) {
    json[joint.name] = {{"id", joint.id},
                        {"zero_rad", joint.zero_rad},
                        {"sign", joint.sign},
                        {"min_rad", joint.min_rad},
                        {"max_rad", joint.max_rad}};
  }
  return json.dump(1) + "\n";
}

/// In the order of joint_names. Members left out are the defaults. Throws UsageError, naming the file and the joint.
inline std::vector<dynamixel::Joint> read_joints(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) { throw example::UsageError(file.string() + ": " + what); };
  const auto shown = [](const std::string& key) {  // on one line
    const std::string start = key.substr(0, 40);
    return nlohmann::json(start).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  };
  const auto json = nlohmann::json::parse(example::read_text(file), nullptr, false);
  if (!json.is_object()) fail("is no JSON object; surefoot-walk joints prints one to begin with");
  std::vector<dynamixel::Joint> joints = default_joints();
  for (const auto& [name, given] : json.items()) {
    const auto found = std::ranges::find(joints, name, &dynamixel::Joint::name);
    if (found == joints.end()) fail("there is no joint " + shown(name) + "; the first one is " + joints.front().name);
    if (!given.is_object()) fail(name + " must be an object with id, zero_rad, sign, min_rad, max_rad");
    for (const auto& [key, value] : given.items()) {
      if (!value.is_number()) fail(name + ": " + shown(key) + " must be a number");
      const double number = value.get<double>();
      if (key == "id") {
        if (!value.is_number_integer() || number < 0 || number > 252) fail(name + ".id must be 0 to 252");
        found->id = value.get<std::uint8_t>();
      } else if (key == "sign") {
        if (number != 1 && number != -1) fail(name + ".sign must be 1 or -1");
        found->sign = number > 0 ? 1 : -1;
      } else if (key == "zero_rad") {
        found->zero_rad = number;
      } else if (key == "min_rad") {
        found->min_rad = number;
      } else if (key == "max_rad") {
        found->max_rad = number;
      } else {
        fail(name + ": " + shown(key) + " is not known; there are id, zero_rad, sign, min_rad, max_rad");
      }
    }
  }
  return joints;
}

}  // namespace sigmaban
