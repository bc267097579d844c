#include "augmented_header.hpp"

#include <array>
#include <cstdio>

namespace diagnose_robot {
namespace {

std::string row(const Robot& robot, std::size_t j, const JointPhysics& p) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "%.9g, %.9g, %.9g, %.9g, %.9g, %.9g, %.9g, %.9g, %.9g}},\n",
                p[Property::coulomb], p[Property::breakaway], p[Property::load_friction], p[Property::drag],
                p[Property::delay], p[Property::lag], p[Property::backlash], p[Property::reading_age],
                p[Property::reading_age] + p[Property::speed_age]);
  return "    {{\"" + robot.joints[j].setup.name + "\", " + text.data();
}

constexpr const char* head =
    R"(// What surefoot-diagnose found at this robot and MJCF cannot say; use it with augmented.xml:
//   surefoot_robot::Extras extras(model);
//   every step: extras.before_step(model, data, goals); mj_step(model, data);
// `goals`: of the drives, in the order of `joints` below; writes data->ctrl.
#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <span>

namespace surefoot_robot {

struct JointExtras {
  const char* name;
  double coulomb, breakaway, load_friction, drag;  // [N m], [N m], [1], [N m s^2/rad^2]
  double delay, lag, backlash;                     // [s], [s], [rad]
  double angle_age, speed_age;                     // [s] of the readings that the drive acts on
};

inline constexpr double stribeck_speed = 0.1;  // [rad/s]

struct Row {
  JointExtras joint;
};

)";

constexpr const char* tail = R"(
class Extras {
 public:
  explicit Extras(const mjModel* m) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const int id = mj_name2id(m, mjOBJ_JOINT, joints[j].joint.name);
      dof_[j] = m->jnt_dofadr[id];
      position_[j] = m->jnt_qposadr[id];
    }
  }

  void before_step(mjModel* m, mjData* d, std::span<const double> goals) {
    const double h = m->opt.timestep;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const JointExtras& joint = joints[j].joint;
      // In mid-step, where MuJoCo's stages are on average.
      const double q = d->qpos[position_[j]] + h / 2 * d->qvel[dof_[j]], v = d->qvel[dof_[j]] + h / 2 * d->qacc[dof_[j]];
      past_[j].push_front(goals[j]);
      const double back = joint.delay / h;
      const auto whole = static_cast<std::size_t>(back);
      while (past_[j].size() > whole + 2) past_[j].pop_back();
      const double newer = past_[j][std::min(whole, past_[j].size() - 1)], older = past_[j][std::min(whole + 1, past_[j].size() - 1)];
      if (!begun_) seen_[j] = q;
      seen_[j] = std::clamp(seen_[j], q - joint.backlash, q + joint.backlash);
      const mjtNum* bias = m->actuator_biasprm + j * mjNBIAS;
      const double gain = m->actuator_gainprm[j * mjNGAIN], older_reading = joint.angle_age * v - joint.speed_age * bias[2] / gain * d->qacc[dof_[j]];
      d->ctrl[j] = newer + (back - static_cast<double>(whole)) * (older - newer) + (q - seen_[j]) * position_drive + older_reading;
      double torque = gain * d->ctrl[j] + bias[0] + bias[1] * q + bias[2] * v;
      if (m->actuator_forcelimited[j]) torque = std::clamp(torque, m->actuator_forcerange[2 * j], m->actuator_forcerange[2 * j + 1]);
      double given = torque;
      if (joint.lag > 0) {
        if (!begun_) lagging_[j] = torque;
        lagging_[j] += h / (h + joint.lag) * (torque - lagging_[j]);
        given = lagging_[j];
      }
      const double slow = v / stribeck_speed;
      m->dof_frictionloss[dof_[j]] = joint.coulomb + joint.breakaway * std::exp(-slow * slow) + joint.load_friction * std::abs(given);
      d->qfrc_applied[dof_[j]] = -joint.drag * v * std::abs(v) + given - torque;
    }
    begun_ = true;
  }

 private:
  std::array<int, joints.size()> dof_{}, position_{};
  std::array<double, joints.size()> seen_{}, lagging_{};
  std::array<std::deque<double>, joints.size()> past_;
  bool begun_ = false;
};

}  // namespace surefoot_robot
)";

}  // namespace

std::string augmented_header(const Robot& robot, const RobotPhysics& physics) {
  std::string text = head;
  text += "inline constexpr int position_drive = " + std::string(robot.setup.drive == DriveKind::position ? "1" : "0") +
          ";\n\n";
  text += "inline constexpr std::array<Row, " + std::to_string(robot.joints.size()) + "> joints{{\n";
  for (std::size_t j = 0; j < robot.joints.size(); ++j) text += row(robot, j, physics[j]);
  return text + "}};\n" + tail;
}

}  // namespace diagnose_robot
