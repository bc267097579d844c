#include "terms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace diagnose_robot {
namespace {

// An assembly error, unlike in every joint.
bool is_of_one_joint(Property p) { return p == Property::constant_torque || p == Property::sensor_bias; }

// Of the bus or the program of the drives, which all joints share; unlike friction it has no size of the motor in it.
bool is_of_electronics(Property p) {
  return p == Property::kp_error || p == Property::kd_error || p == Property::torque_gain || p == Property::delay ||
         p == Property::lag || p == Property::load_friction || is_of_timing(p);
}

bool is_considered(const Robot& robot, const PropertyInfo& info, int joint) {
  const bool position = robot.setup.drive == DriveKind::position;
  const RobotJoint& at = robot.joints[static_cast<std::size_t>(joint)];
  if (!(position ? info.position_drive : info.torque_drive)) return false;
  if (is_of_body(info.property)) return robot.setup.calibrate_bodies;
  if (!is_of_body(info.property) && (info.calibration || info.property == Property::torque_gain) &&
      !robot.setup.calibrate_gains)
    return false;
  if (info.property == Property::torque_limit) return at.setup.limit > 0;
  if (info.property == Property::kd_error) return at.setup.kd > 0;
  return !is_of_pair(info.property) || at.before >= 0;
}

// How much later recorded torques act than they are logged, how old readings are: one clock for all joints.
bool is_of_clock(const Robot& robot, Property p) {
  return (p == Property::delay && robot.setup.drive == DriveKind::torque) || is_of_timing(p);
}

// Whether links have the same mass and inertia, so that an error of the model is that of all of them.
bool are_alike(const Robot& robot, const std::vector<int>& joints) {
  constexpr double same = 0.01;  // relative
  const mjModel* m = robot.model.model.get();
  const auto differ = [&](double a, double b) { return std::abs(a - b) > same * std::max(std::abs(a), std::abs(b)); };
  const int first = robot.joints[static_cast<std::size_t>(joints.front())].model.body;
  return std::ranges::none_of(joints, [&](int j) {
    const int body = robot.joints[static_cast<std::size_t>(j)].model.body;
    return differ(m->body_mass[first], m->body_mass[body]) ||
           differ(m->body_inertia[3 * first], m->body_inertia[3 * body]);
  });
}

// Whether a group may have one size of this.
bool may_be_tied(const Robot& robot, const PropertyInfo& info, const std::vector<int>& joints) {
  if (joints.size() == 1) return true;
  return !is_of_one_joint(info.property) && (!is_of_body(info.property) || are_alike(robot, joints));
}

Term make_term(const std::vector<int>& joints, int group, const PropertyInfo& info,
               const std::vector<JointScale>& scales) {
  Term term;
  term.property = info.property;
  term.joints = joints;
  term.group = group;
  term.typical = 0;
  for (const int j : joints) {
    term.typical +=
        typical_size(info.property, scales[static_cast<std::size_t>(j)]) / static_cast<double>(joints.size());
  }
  term.low = info.low * term.typical;
  term.high = info.high * term.typical;
  if (group == single_joint) term.low = -term.high;  // a joint may have less than its group
  return term;
}

}  // namespace

Term term_of_joint(const PropertyInfo& info, std::size_t joint, const JointScale& scale) {
  Term term;
  term.property = info.property;
  term.joints = {static_cast<int>(joint)};
  term.typical = typical_size(info.property, scale);
  term.low = info.low * term.typical;
  term.high = info.high * term.typical;
  return term;
}

std::vector<Term> all_terms(const Robot& robot, const std::vector<JointScale>& scales) {
  std::vector<Term> terms;
  for (const PropertyInfo& info : property_table()) {
    for (std::size_t g = 0; g < robot.groups.size(); ++g) {
      std::vector<int> joints;
      for (const int j : robot.groups[g]) {
        if (is_considered(robot, info, j)) joints.push_back(j);
      }
      if (is_of_clock(robot, info.property) && robot.groups.size() > 1) continue;
      if (!joints.empty() && may_be_tied(robot, info, joints))
        terms.push_back(make_term(joints, static_cast<int>(g), info, scales));
    }
  }
  std::vector<int> every(robot.joints.size());
  std::iota(every.begin(), every.end(), 0);
  for (const PropertyInfo& info : property_table()) {
    const bool may = std::ranges::all_of(every, [&](int j) { return is_considered(robot, info, j); });
    if (robot.groups.size() > 1 && is_of_electronics(info.property) && may)
      terms.push_back(make_term(every, all_joints, info, scales));
  }
  for (const PropertyInfo& info : property_table()) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const int joint = static_cast<int>(j);
      const auto& group = robot.groups[static_cast<std::size_t>(robot.joints[j].group)];
      if (is_of_clock(robot, info.property)) continue;
      if (group.size() > 1 && is_considered(robot, info, joint)) terms.push_back(make_term({joint}, -1, info, scales));
    }
  }
  return terms;
}

std::vector<PhysicsEntry> entries_of(const std::vector<Term>& terms) {
  std::vector<PhysicsEntry> entries;
  for (const Term& term : terms) {
    for (const int j : term.joints) {
      const auto same = [&](const PhysicsEntry& entry) { return entry.property == term.property && entry.joint == j; };
      if (std::ranges::none_of(entries, same)) entries.push_back({term.property, j});
    }
  }
  return entries;
}

RobotPhysics physics_of(const std::vector<Term>& terms, const Eigen::VectorXd& theta, const RobotPhysics& nominal) {
  RobotPhysics physics = nominal;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const double change = theta[static_cast<Eigen::Index>(t)];
    for (const int j : terms[t].joints) physics[static_cast<std::size_t>(j)][terms[t].property] += change;
  }
  for (JointPhysics& joint : physics) {
    for (const PropertyInfo& info : property_table()) {
      double& value = joint[info.property];
      if (info.low >= 0) value = std::max(0.0, value);
      if (info.property == Property::torque_limit) value = std::min(value, 0.99);
    }
  }
  return physics;
}

double nominal_of(const Robot& robot, const Term& term) {
  double sum = 0;
  for (const int j : term.joints) sum += robot.nominal[static_cast<std::size_t>(j)][term.property];
  return sum / static_cast<double>(term.joints.size());
}

std::string place_of(const Robot& robot, const Term& term) {
  if (term.group == all_joints) return "all joints";
  if (term.group >= 0 && term.joints.size() > 1) return robot.setup.groups[static_cast<std::size_t>(term.group)].name;
  return robot.joints[static_cast<std::size_t>(term.joints.front())].setup.name;
}

std::string unit_of(const Robot& robot, const Term& term) {
  std::string unit = info_of(term.property).unit;
  if (!robot.joints[static_cast<std::size_t>(term.joints.front())].model.slides) return unit;
  if (unit == "kg m^2") return "kg";
  if (unit == "rad") return "m";
  if (unit.starts_with("N m")) unit = "N" + unit.substr(3);
  const std::size_t angle = unit.find("rad");
  return angle == std::string::npos ? unit : unit.replace(angle, 3, "m");
}

}  // namespace diagnose_robot
