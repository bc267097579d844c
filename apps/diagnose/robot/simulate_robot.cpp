#include "simulate_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surefoot/optimize/coupled_dry_friction.hpp"

namespace diagnose_robot {
namespace {

constexpr double longest_step = 0.002;  // [s]: of second order that is far below what any encoder sees of a drive
constexpr double stiff = 1;             // damping over a step, beyond which it is taken fully implicit, lest it rings
constexpr double runaway = 1e3;         // [rad]

// Mean of the goal, held between rows, from `from` to `from + length`; smooth in `from`, so that delays can be fitted.
double mean_goal(const RobotRecording& r, Eigen::Index joint, Eigen::Index row, double from, double length) {
  Eigen::Index k = row;
  while (k > 0 && r.time[k] > from) --k;
  double sum = 0, at = from;
  const double end = from + length;
  while (at < end) {
    const double until = k + 1 < r.time.size() ? std::min(end, std::max(at, r.time[k + 1])) : end;
    sum += (until - at) * r.goal(k, joint);
    at = until;
    if (k + 1 < r.time.size()) ++k;
  }
  return sum / length;
}

struct DriveTorque {
  double constant = 0, damping = 0;  // torque: constant - damping * speed
};

struct Simulation {
  const Robot& robot;
  const RobotRecording& recording;
  const RobotPhysics& physics;
  ModelPointer model;
  DataPointer data;
  Eigen::MatrixXd mass;
  Eigen::VectorXd q, v, before, middle, next, momentum, friction, drive_damping, seen,
      lagging;  // middle: speed in mid-step
  surefoot::CoupledDryFriction work;

  Simulation(const Robot& robot_, const RobotRecording& recording_, const StartState& start,
             const RobotPhysics& physics_)
      : robot(robot_),
        recording(recording_),
        physics(physics_),
        model(model_with_bodies(robot_, physics_)),
        data(mj_makeData(model.get())) {
    const auto n = static_cast<Eigen::Index>(robot.joints.size());
    mass.setZero(n, n);
    q = start.angle;
    for (Eigen::Index i = 0; i < n; ++i) q[i] -= joint(i)[Property::sensor_bias];
    v = before = middle = next = drive_damping = start.speed;
    seen = q;
    momentum.resize(n);
    friction.resize(n);
    lagging.setConstant(n, std::numeric_limits<double>::quiet_NaN());
  }

  const JointPhysics& joint(Eigen::Index i) const { return physics[static_cast<std::size_t>(i)]; }

  // Mass matrix of the joints that move, and `data->qfrc_bias`: gravity and Coriolis forces.
  void rigid_bodies() {
    const mjModel* m = model.get();
    mjData* d = data.get();
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      d->qpos[robot.joints[j].model.position] = q[static_cast<Eigen::Index>(j)];
      d->qvel[robot.joints[j].model.dof] = middle[static_cast<Eigen::Index>(j)];
    }
    mj_kinematics(m, d);
    mj_comPos(m, d);
    mj_crb(m, d);
    mj_comVel(m, d);
    mj_rne(m, d, 0, d->qfrc_bias);
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      int address = m->dof_Madr[robot.joints[j].model.dof];
      for (int dof = robot.joints[j].model.dof; dof >= 0; dof = m->dof_parentid[dof]) {
        const int other = robot.joint_of_dof[static_cast<std::size_t>(dof)];
        const double value = d->qM[address++];
        if (other < 0) continue;
        mass(static_cast<Eigen::Index>(j), other) = value;
        mass(other, static_cast<Eigen::Index>(j)) = value;
      }
    }
  }

  DriveTorque drive(Eigen::Index i, Eigen::Index row, double t, double h) {
    const JointSetup& stated = robot.joints[static_cast<std::size_t>(i)].setup;
    const JointPhysics& p = joint(i);
    const double goal =
        p[Property::delay] > 0 ? mean_goal(recording, i, row, t - p[Property::delay], h) : recording.goal(row, i);
    // Positions are those of mid-step.
    seen[i] = std::clamp(seen[i], q[i] - p[Property::backlash], q[i] + p[Property::backlash]);
    const double gain = 1 + p[Property::torque_gain];
    DriveTorque torque{gain * stated.kp * (1 + p[Property::kp_error]) * (goal - seen[i] - p[Property::sensor_bias]),
                       gain * stated.kd * (1 + p[Property::kd_error])};
    const double limit = stated.limit * (1 - p[Property::torque_limit]);
    const double now = torque.constant - torque.damping * middle[i];
    if (limit > 0 && std::abs(now) > limit) torque = {std::copysign(limit, now), 0};
    if (p[Property::lag] > 0) {
      const double share = 1 - std::exp(-h / p[Property::lag]);
      if (!std::isfinite(lagging[i])) lagging[i] = now;
      torque.constant = (1 - share) * lagging[i] + share * torque.constant;
      torque.damping *= share;
    }
    return torque;
  }

  void step(Eigen::Index row, double t, double h) {
    middle = 1.5 * v - 0.5 * before;
    before = v;
    q += h / 2 * v;
    rigid_bodies();
    const mjModel* m = model.get();
    momentum.noalias() = mass * v;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const JointPhysics& p = joint(i);
      const ModelJoint& model_joint = robot.joints[static_cast<std::size_t>(i)].model;
      const DriveTorque torque = drive(i, row, t, h);
      const double spring = m->jnt_stiffness[model_joint.id] * (q[i] - m->qpos_spring[model_joint.position]);
      const double force = torque.constant + p[Property::constant_torque] -
                           p[Property::drag] * middle[i] * std::abs(middle[i]) - data->qfrc_bias[model_joint.dof] -
                           spring;
      mass(i, i) += p[Property::armature];
      const double damping = p[Property::viscous] + torque.damping;
      const double implicit = h * damping < stiff * mass(i, i) ? 0.5 : 1;
      momentum[i] += p[Property::armature] * v[i] + h * (force - (1 - implicit) * damping * v[i]);
      mass(i, i) += h * implicit * damping;
      const double slow = middle[i] / stribeck_speed;
      friction[i] = h * (p[Property::coulomb] + p[Property::breakaway] * std::exp(-slow * slow) +
                         p[Property::load_friction] * std::abs(torque.constant - torque.damping * middle[i]));
      if (p[Property::lag] > 0) lagging[i] = torque.constant;
      drive_damping[i] = torque.damping;
    }
    surefoot::solve_coupled_dry_friction(mass, momentum, friction, work, next);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (joint(i)[Property::lag] > 0) lagging[i] -= drive_damping[i] * next[i];
    }
    v.swap(next);
    q += h / 2 * v;
  }

  void read(Eigen::MatrixXd& readings, Eigen::Index row) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) readings(row, i) = q[i] + joint(i)[Property::sensor_bias];
  }
};

}  // namespace

double simulation_step(const Robot& robot, const RobotRecording& recording) {
  const double period = recording.row_period();
  const double wanted = robot.setup.step > 0 ? robot.setup.step : longest_step;
  return period / std::max(1.0, std::ceil(period / wanted - 1e-6));
}

StartState start_of(const Motion& motion) { return {motion.q.row(0), motion.v.row(0)}; }

Eigen::MatrixXd simulate_robot(const Robot& robot, const RobotRecording& recording, const StartState& start,
                               const RobotPhysics& physics) {
  Simulation simulation(robot, recording, start, physics);
  const Eigen::Index rows = recording.time.size();
  Eigen::MatrixXd readings =
      Eigen::MatrixXd::Constant(rows, recording.angle.cols(), std::numeric_limits<double>::infinity());
  const double wanted = simulation_step(robot, recording);
  simulation.read(readings, 0);
  for (Eigen::Index k = 0; k + 1 < rows; ++k) {
    const double period = recording.time[k + 1] - recording.time[k];
    const auto steps = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::lround(period / wanted)));
    const double h = period / static_cast<double>(steps);
    for (Eigen::Index s = 0; s < steps; ++s) simulation.step(k, recording.time[k] + static_cast<double>(s) * h, h);
    if (!(simulation.q.cwiseAbs().maxCoeff() < runaway)) return readings;
    simulation.read(readings, k + 1);
  }
  return readings;
}

}  // namespace diagnose_robot
