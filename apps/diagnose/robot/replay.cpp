#include <algorithm>
#include <cmath>
#include <limits>

#include "augmented_xml.hpp"
#include "robot_step.hpp"
#include "surefoot/core/error.hpp"
#include "xml_text.hpp"

namespace diagnose_robot {
namespace {

// As augmented.hpp has it, step by step.
struct Replay {
  const Robot& robot;
  const RobotPhysics& physics;
  const RobotRecording& recording;
  ModelPointer model;
  DataPointer data;
  std::vector<int> position, dof;
  std::vector<double> seen, lagging;
  bool begun = false;

  // A late goal changes within a step: its mean over the step, not what it is at the beginning, which would be later.
  double goal(Eigen::Index joint, double t, double late) const {
    const auto next = std::upper_bound(recording.time.begin(), recording.time.end(), t + 1e-9) - recording.time.begin();
    const Eigen::Index row = std::max<Eigen::Index>(0, next - 1);
    return late != 0 ? mean_goal(recording, joint, row, t - late, model->opt.timestep) : recording.goal(row, joint);
  }

  void before_step(double t) {
    mjModel* m = model.get();
    mjData* d = data.get();
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const JointPhysics& p = physics[j];
      // In mid-step, where MuJoCo's stages are on average.
      const double half = m->opt.timestep / 2, q = d->qpos[position[j]] + half * d->qvel[dof[j]];
      const double v = d->qvel[dof[j]] + half * d->qacc[dof[j]];
      const int a = static_cast<int>(j);
      if (!begun) seen[j] = q;
      seen[j] = std::clamp(seen[j], q - p[Property::backlash], q + p[Property::backlash]);
      const mjtNum* bias = m->actuator_biasprm + a * mjNBIAS;
      const double gain = m->actuator_gainprm[a * mjNGAIN];
      const double age = p[Property::reading_age], of_speed = age + p[Property::speed_age];
      const double older_reading = age * v - of_speed * bias[2] / gain * d->qacc[dof[j]];
      d->ctrl[a] = goal(a, t, p[Property::delay] + p[Property::goal_clock]) + q - seen[j] + older_reading;
      double torque = gain * d->ctrl[a] + bias[0] + bias[1] * q + bias[2] * v;
      if (m->actuator_forcelimited[a] != 0)
        torque = std::clamp(torque, m->actuator_forcerange[2 * a], m->actuator_forcerange[2 * a + 1]);
      double given = torque;
      if (p[Property::lag] > 0) {
        if (!begun) lagging[j] = torque;
        lagging[j] += lag_share(m->opt.timestep, p[Property::lag]) * (torque - lagging[j]);
        given = lagging[j];
      }
      const double slow = v / stribeck_speed;
      m->dof_frictionloss[dof[j]] = p[Property::coulomb] + p[Property::breakaway] * std::exp(-slow * slow) +
                                    p[Property::load_friction] * std::abs(given);
      d->qfrc_applied[dof[j]] = -p[Property::drag] * v * std::abs(v) + given - torque;
    }
    begun = true;
  }
};

// MuJoCo begins anew where a position, speed or acceleration is no number or too large.
bool ran_away(const mjData& data) {
  return data.warning[mjWARN_BADQPOS].number + data.warning[mjWARN_BADQVEL].number +
             data.warning[mjWARN_BADQACC].number >
         0;
}

}  // namespace

Eigen::MatrixXd replay(const Robot& robot, const AugmentedModel& augmented, const RobotPhysics& physics,
                       const RobotRecording& recording, const StartState& start) {
  std::string complaint;
  // What was held in the recording does not move: its joints are taken out.
  const std::string text = without_joints(augmented.xml, robot.setup.held);
  Replay r{robot, physics, recording, compile_model(text, {}, false, complaint), nullptr, {}, {}, {}, {}};
  if (!r.model) throw surefoot::DiagnoseError("augmented.xml: MuJoCo cannot load it: " + complaint);
  mjModel* m = r.model.get();
  m->opt.disableflags |= mjDSBL_CONTACT;
  if (robot.setup.ignore_contacts) m->opt.disableflags |= mjDSBL_LIMIT;  // as those, no part of the diagnosis
  r.data.reset(mj_makeData(m));
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const int id = mj_name2id(m, mjOBJ_JOINT, robot.joints[j].setup.name.c_str());
    r.position.push_back(m->jnt_qposadr[id]);
    r.dof.push_back(m->jnt_dofadr[id]);
    const auto c = static_cast<Eigen::Index>(j);
    r.data->qpos[r.position[j]] = start.angle[c] - physics[j][Property::sensor_bias];
    r.data->qvel[r.dof[j]] = start.speed[c];
  }
  r.seen.assign(robot.joints.size(), 0);
  r.lagging.assign(robot.joints.size(), 0);
  Eigen::MatrixXd readings(recording.time.size(), recording.angle.cols());
  const double begin = recording.time[0];
  for (Eigen::Index k = 0; k < readings.rows(); ++k) {
    while (begin + r.data->time < recording.time[k] - m->opt.timestep / 2) {
      r.before_step(begin + r.data->time);
      mj_step(m, r.data.get());
      if (ran_away(*r.data)) {
        readings.bottomRows(readings.rows() - k).setConstant(std::numeric_limits<double>::infinity());
        return readings;
      }
    }
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      readings(k, static_cast<Eigen::Index>(j)) = r.data->qpos[r.position[j]] + physics[j][Property::sensor_bias];
    }
  }
  return readings;
}

}  // namespace diagnose_robot
