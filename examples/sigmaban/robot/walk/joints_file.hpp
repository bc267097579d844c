// Which servo moves which joint: a JSON file, for robots whose servos are not numbered 1 to 12 from zero.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "../../../../apps/common/files.hpp"
#include "../servos/joint.hpp"
#include "../walk_engine/joint_targets.hpp"

namespace sigmaban {

/// Held in one pose while the legs walk.
struct PostureJoint {
  std::string_view name;
  double pose_rad = 0;
};

/// Neck and arms. Shoulders and elbows as a walking robot holds them: arms down, a little outwards, hands in front.
inline constexpr std::array<PostureJoint, 8> posture_joints{{{"head_yaw", 0},
                                                             {"head_pitch", 0},
                                                             {"left_shoulder_pitch", 0.2},
                                                             {"left_shoulder_roll", 0.2},
                                                             {"left_elbow", -1.2},
                                                             {"right_shoulder_pitch", 0.2},
                                                             {"right_shoulder_roll", -0.2},
                                                             {"right_elbow", -1.2}}};

/// The joints of a robot: twelve of the legs in the order of joint_names, then those that are held in a pose.
struct RobotJoints {
  std::vector<dynamixel::Joint> joints;
  std::vector<std::size_t> ports;  // of each: the number of its serial port, from 0
  std::vector<double> poses_rad;   // of those after the legs
};

/// Servo 1 is the first of joint_names and so on, 13 the first of posture_joints if `all`; each at its centre where the
/// joint is straight, all on the first port.
inline RobotJoints default_joints(bool all = false) {
  RobotJoints robot;
  const auto add = [&](std::string_view name) {
    robot.joints.push_back({.name = std::string(name), .id = static_cast<std::uint8_t>(robot.joints.size() + 1)});
    robot.ports.push_back(0);
  };
  for (const std::string_view name : joint_names) add(name);
  for (const PostureJoint& joint : posture_joints) {
    if (!all) break;
    add(joint.name);
    robot.poses_rad.push_back(joint.pose_rad);
  }
  return robot;
}

inline std::string joints_to_json(const RobotJoints& robot) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const dynamixel::Joint& joint = robot.joints[i];
    auto& entry =
        json[joint.name] = {{"id", joint.id},           {"zero_rad", joint.zero_rad}, {"sign", joint.sign},
                            {"min_rad", joint.min_rad}, {"max_rad", joint.max_rad},   {"port", robot.ports[i]}};
    if (i >= joint_names.size()) entry["pose_rad"] = robot.poses_rad[i - joint_names.size()];
  }
  return json.dump(1) + "\n";
}

namespace joints_file_detail {

/// Sets one member. Returns what is wrong with it, or nothing.
inline std::string set_member(RobotJoints& robot, std::size_t i, const std::string& key, const nlohmann::json& value) {
  if (!value.is_number()) return "must be a number";
  dynamixel::Joint& joint = robot.joints[i];
  const double number = value.get<double>();
  if (key == "id") {
    if (!value.is_number_integer() || number < 0 || number > 252) return "must be 0 to 252";
    joint.id = value.get<std::uint8_t>();
  } else if (key == "sign") {
    if (number != 1 && number != -1) return "must be 1 or -1";
    joint.sign = number > 0 ? 1 : -1;
  } else if (key == "port") {
    constexpr double most = 7;  // more ports than a robot of 20 joints can have a use for
    if (!value.is_number_integer() || number < 0 || number > most) return "must be 0 to 7";
    robot.ports[i] = value.get<std::size_t>();
  } else if (key == "zero_rad") {
    joint.zero_rad = number;
  } else if (key == "min_rad") {
    joint.min_rad = number;
  } else if (key == "max_rad") {
    joint.max_rad = number;
  } else if (key == "pose_rad" && i >= joint_names.size()) {
    robot.poses_rad[i - joint_names.size()] = number;
  } else {
    return "is not known; there are id, zero_rad, sign, min_rad, max_rad, port, and pose_rad of neck and arms";
  }
  return "";
}

/// Without the joints of neck and arms that are not named.
inline RobotJoints without_unnamed(const RobotJoints& all, const nlohmann::json& named) {
  RobotJoints kept;
  for (std::size_t i = 0; i < all.joints.size(); ++i) {
    const bool posture = i >= joint_names.size();
    if (posture && !named.contains(all.joints[i].name)) continue;
    kept.joints.push_back(all.joints[i]);
    kept.ports.push_back(all.ports[i]);
    if (posture) kept.poses_rad.push_back(all.poses_rad[i - joint_names.size()]);
  }
  return kept;
}

}  // namespace joints_file_detail

/// The legs, and of neck and arms the joints that the file names. Members left out are the defaults. Throws UsageError,
/// naming the file and the joint.
inline RobotJoints read_joints(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) { throw example::UsageError(file.string() + ": " + what); };
  const auto shown = [](const std::string& key) {  // on one line
    const std::string start = key.substr(0, 40);
    return nlohmann::json(start).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  };
  const auto json = nlohmann::json::parse(example::read_text(file), nullptr, false);
  if (!json.is_object()) fail("is no JSON object; surefoot-walk joints prints one to begin with");
  RobotJoints robot = default_joints(true);
  for (const auto& [name, given] : json.items()) {
    const auto found = std::ranges::find(robot.joints, name, &dynamixel::Joint::name);
    if (found == robot.joints.end()) {
      fail("there is no joint " + shown(name) + "; the first one is " + robot.joints.front().name);
    }
    if (!given.is_object()) fail(name + " must be an object with id, zero_rad, sign, min_rad, max_rad, port");
    const auto place = static_cast<std::size_t>(found - robot.joints.begin());
    for (const auto& [key, value] : given.items()) {
      const std::string wrong = joints_file_detail::set_member(robot, place, key, value);
      if (!wrong.empty()) fail(name + ": " + shown(key) + " " + wrong);
    }
  }
  return joints_file_detail::without_unnamed(robot, json);
}

}  // namespace sigmaban
