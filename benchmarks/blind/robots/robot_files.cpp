#include <algorithm>
#include <functional>

#include "robot_case.hpp"
#include "text.hpp"

namespace blind_robots {
namespace {

std::string numbers(std::initializer_list<double> values) {
  std::string result;
  for (const double value : values) result += (result.empty() ? "" : " ") + plants::text(value, "%.9g");
  return result;
}

// A slender rod along -z, and those that hang on it.
std::string body(const RobotCase& robot, const Joint& joint, bool real) {
  const HiddenJoint hidden = real ? joint.hidden : HiddenJoint();
  const double mass = joint.mass * (1 + hidden.mass_error), l = joint.length;
  double total = mass, centre = -l / 2, wide = mass * (l * l / 12 + 0.0009), thin = mass * 0.0009;
  if (hidden.payload > 0) {
    total += hidden.payload;
    const double reduced = mass * hidden.payload / total, arm = l / 2;
    wide += reduced * arm * arm;
    centre = -(mass * l / 2 + hidden.payload * l) / total;
  }
  const auto parent = std::ranges::find(robot.joints, joint.parent, &Joint::name);
  const double drop = parent == robot.joints.end() ? 0 : parent->length;
  const std::string axis = joint.axis == 'x' ? "1 0 0" : joint.axis == 'y' ? "0 1 0" : "0 0 1";
  std::string text = "<body name=\"" + joint.name + "_link\" pos=\"" +
                     numbers({0, parent == robot.joints.end() ? joint.offset : 0, -drop}) + "\">\n<inertial pos=\"" +
                     numbers({0, 0, centre}) + "\" mass=\"" + numbers({total}) + "\" diaginertia=\"" +
                     numbers({wide, wide, thin}) + "\"/>\n<joint name=\"" + joint.name + "\" axis=\"" + axis +
                     "\" armature=\"" + numbers({file_armature + hidden.armature}) + "\"";
  if (real) {
    text += " damping=\"" + numbers({hidden.viscous}) + "\" frictionloss=\"" + numbers({hidden.coulomb}) +
            "\" solreffriction=\"0.002 1\" solimpfriction=\"0.98 0.99 0.001 0.5 2\"";
  }
  text += "/>\n<site name=\"" + joint.name + "_end\" pos=\"" + numbers({0, 0, -l}) + "\"/>\n";
  for (const Joint& next : robot.joints) {
    if (next.parent == joint.name) text += body(robot, next, real);
  }
  return text + "</body>\n";
}

}  // namespace

std::string robot_xml(const RobotCase& robot, bool real) {
  std::string text = "<mujoco model=\"" + robot.family + "\">\n<option timestep=\"0.0005\"/>\n<worldbody>\n";
  for (const Joint& joint : robot.joints) {
    if (joint.parent.empty()) text += body(robot, joint, real);
  }
  return text + "</worldbody>\n</mujoco>\n";
}

std::string robot_setup(const RobotCase& robot) {
  std::string text =
      "schema = \"surefoot.robot/1\"\ntime = \"t_s\"\ncalibrate = [\"gains\", \"bodies\"]\n[drive]\nkind = \"" +
      std::string(robot.torque_driven ? "torque" : "position") + "\"\n[groups]\n";
  std::vector<std::string> groups;
  for (const Joint& joint : robot.joints) {
    if (std::ranges::find(groups, joint.group) == groups.end()) groups.push_back(joint.group);
  }
  for (const std::string& group : groups) {
    std::string list;
    for (const Joint& joint : robot.joints) {
      if (joint.group == group) list += (list.empty() ? "\"" : ", \"") + joint.name + "\"";
    }
    text += group + " = [" + list + "]\n";
  }
  for (const Joint& joint : robot.joints) {
    text += "[joints." + joint.name + "]\nangle = \"" + joint.name + "_rad\"\n";
    if (robot.torque_driven) {
      text += "torque = \"torque_" + joint.name + "_N_m\"\n";
    } else {
      text += "goal = \"goal_" + joint.name + "_rad\"\nkp = " + numbers({joint.kp}) + "\nkd = " + numbers({joint.kd}) +
              "\nlimit = " + numbers({joint.limit}) + "\n";
    }
  }
  return text;
}

}  // namespace blind_robots
