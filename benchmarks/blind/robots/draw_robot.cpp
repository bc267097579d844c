#include <algorithm>
#include <cmath>
#include <functional>

#include "robot_case.hpp"
#include "text.hpp"

namespace blind_robots {
namespace {

constexpr double gravity = 9.81;  // [m/s^2]

void draw_arm(RobotCase& robot, std::size_t count, plants::Random& random) {
  static const std::string axes = "zyyxyxz";
  for (std::size_t j = 0; j < count; ++j) {
    Joint joint;
    joint.name = "arm_" + std::to_string(j + 1);
    joint.group = j < (count + 1) / 2 ? "shoulder" : "wrist";
    joint.parent = j == 0 ? "" : robot.joints.back().name;
    joint.axis = count == 2 ? 'y' : axes[j];
    const double shrink = std::pow(0.85, static_cast<double>(j));
    joint.length = shrink * random.uniform(0.15, 0.3);
    joint.mass = shrink * random.uniform(0.8, 2.5);
    robot.joints.push_back(joint);
  }
}

void draw_legs(RobotCase& robot, std::size_t legs, plants::Random& random) {
  const double lengths[] = {random.uniform(0.05, 0.1), random.uniform(0.18, 0.25), random.uniform(0.18, 0.25)};
  const double masses[] = {random.uniform(0.5, 0.8), random.uniform(0.8, 1.3), random.uniform(0.2, 0.4)};
  const char* parts[] = {"hip", "thigh", "calf"};
  static const std::vector<std::string> places{"FL", "FR", "RL", "RR", "ML", "MR", "BL", "BR"};
  for (std::size_t number = 0; number < legs; ++number) {
    const std::string& leg = places.at(number);
    for (std::size_t p = 0; p < 3; ++p) {
      Joint joint;
      joint.name = leg + "_" + parts[p];
      joint.group = parts[p];
      joint.parent = p == 0 ? "" : robot.joints.back().name;
      joint.axis = p == 0 ? 'x' : 'y';
      joint.length = lengths[p];
      joint.mass = masses[p];
      joint.offset = leg[1] == 'L' ? 0.1 : -0.1;
      robot.joints.push_back(joint);
    }
  }
}

// What hangs on a joint, from the last on: weight and inertia at full stretch.
void size_drives(RobotCase& robot, plants::Random& random) {
  for (std::size_t j = robot.joints.size(); j-- > 0;) {
    Joint& joint = robot.joints[j];
    double reach = joint.length, mass = joint.mass;
    joint.torque = gravity * mass * reach / 2;
    joint.inertia = file_armature + mass * reach * reach / 3;
    std::string behind = joint.name;
    for (std::size_t k = j + 1; k < robot.joints.size(); ++k) {
      if (robot.joints[k].parent != behind) continue;
      behind = robot.joints[k].name;
      const double middle = reach + robot.joints[k].length / 2;
      joint.torque += gravity * robot.joints[k].mass * middle;
      joint.inertia += robot.joints[k].mass * middle * middle;
      reach += robot.joints[k].length;
    }
  }
  const double softness = random.uniform(0.02, 0.06);  // [rad] under full load
  for (Joint& joint : robot.joints) {
    joint.kp = joint.torque / softness;
    joint.kd = 1.4 * std::sqrt(joint.kp * joint.inertia) * 0.5;
    joint.limit = 5 * joint.torque;
  }
}

struct Hidden {
  const char *effect, *parameter;
  double low, high;  // of the size that `size` says
  std::function<double(const Joint&)> size;
  double HiddenJoint::*where;
  bool groups;            // friction and inertia come in groups and everywhere, other faults in one joint
  bool position, torque;  // which robots may have it
};

const std::vector<Hidden>& catalogue() {
  static const auto torque = [](const Joint& joint) { return joint.torque; };
  static const auto one = [](const Joint&) { return 1.0; };
  static const std::vector<Hidden> list{
      {"coulomb_friction", "level", 0.05, 0.3, torque, &HiddenJoint::coulomb, true, true, true},
      {"viscous_friction", "damping", 0.05, 0.3, torque, &HiddenJoint::viscous, true, true, true},
      {"load_dependent_friction", "factor", 0.1, 0.3, one, &HiddenJoint::load_friction, true, true, true},
      {"rotor_inertia", "armature", 0.3, 1.5, [](const Joint& joint) { return joint.inertia; }, &HiddenJoint::armature,
       true, true, true},
      {"input_delay", "delay", 0.01, 0.04, one, &HiddenJoint::delay, true, true, false},
      {"backlash", "half_width", 0.005, 0.03, one, &HiddenJoint::backlash, false, true, false},
      {"saturation", "missing_share", 0.85, 0.93, one, &HiddenJoint::missing_limit, false, true, false},
      {"input_gain", "gain_error", 0.15, 0.5, one, &HiddenJoint::weakness, false, true, true},
      {"link_mass", "mass_error", 0.2, 0.8, one, &HiddenJoint::mass_error, false, true, true},
      {"payload", "mass", 0.3, 1.0, [](const Joint& joint) { return joint.mass; }, &HiddenJoint::payload, false, true,
       true},
      {"sensor_bias", "bias", 0.04, 0.15, one, &HiddenJoint::bias, false, true, true},
  };
  return list;
}

// The joints of a place, and its name.
std::pair<std::string, std::vector<std::size_t>> draw_place(const RobotCase& robot, const Hidden& what,
                                                            plants::Random& random) {
  const std::size_t chosen = random.index(robot.joints.size());
  const double where = random.uniform(0, 1);
  if (!what.groups || where < 0.4) {
    const bool last = what.where == &HiddenJoint::payload;  // at the end of an arm or a leg
    std::size_t joint = chosen;
    if (last) joint = robot.family.starts_with("legs") ? 3 * (chosen / 3) + 2 : robot.joints.size() - 1;
    return {robot.joints[joint].name, {joint}};
  }
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (where >= 0.75 || robot.joints[j].group == robot.joints[chosen].group) joints.push_back(j);
  }
  if (joints.size() == 1) return {robot.joints[joints[0]].name, joints};
  return {where >= 0.75 ? "all" : robot.joints[chosen].group, joints};
}

// One size for a place: of the joint that is in the middle of it.
void hide(RobotCase& robot, const Hidden& what, plants::Random& random) {
  const auto [place, joints] = draw_place(robot, what, random);
  const Joint& middle = robot.joints[joints[joints.size() / 2]];
  double value = random.uniform(what.low, what.high) * what.size(middle);
  if (what.where == &HiddenJoint::bias) value *= random.sign();
  for (const std::size_t j : joints) robot.joints[j].hidden.*what.where = value;
  double stated = value;
  std::string effect = what.effect, parameter = what.parameter;
  if (what.where == &HiddenJoint::armature) stated = value + file_armature;
  if (what.where == &HiddenJoint::weakness) {
    stated = robot.torque_driven ? 1 / (1 - value) - 1 : -value;
    if (robot.torque_driven) {
      effect = "sensor_scale";
      parameter = "scale_error";
    }
  }
  robot.truth.push_back({{"effect", effect}, {"place", place}, {"parameter", parameter}, {"value", stated}});
}

}  // namespace

RobotCase draw_robot(plants::Random& random, const std::string& family, std::optional<int> faults) {
  RobotCase robot;
  robot.family = family;
  robot.truth = nlohmann::ordered_json::array();
  if (family.starts_with("legs")) {
    draw_legs(robot, std::stoul(family.substr(4)) / 3, random);
  } else {
    draw_arm(robot, static_cast<std::size_t>(family[3] - '0'), random);
    robot.torque_driven = random.chance(0.5);
  }
  size_drives(robot, random);
  if (faults == 0) return robot;
  if (!faults && random.chance(0.08)) {
    const std::size_t a = random.index(robot.joints.size() - 1);
    robot.swapped.emplace_back(a, a + 1);
    robot.truth.push_back(
        {{"effect", "columns_swapped"}, {"place", robot.joints[a].name}, {"parameter", ""}, {"value", 0}});
    return robot;
  }
  const double drawn = random.uniform(0, 1);
  const int count = faults.value_or(drawn < 0.6 ? 1 : drawn < 0.85 ? 2 : 3);
  std::vector<const Hidden*> left;
  for (const Hidden& what : catalogue()) {
    if (robot.torque_driven ? what.torque : what.position) left.push_back(&what);
  }
  for (int i = 0; i < count; ++i) {
    const std::size_t chosen = random.index(left.size());
    hide(robot, *left[chosen], random);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  return robot;
}

}  // namespace blind_robots
