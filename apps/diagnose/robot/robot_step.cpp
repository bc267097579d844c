#include "robot_step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "inverse_dynamics.hpp"

namespace diagnose_robot {
namespace {

constexpr double runaway = 1e3;          // [rad]
constexpr double shortest = 1e-12;       // [s]: rounding
constexpr double smallest_share = 1e-6;  // of a step, that a substep takes
// The same where a torque meets its limit: it does not jump there, so that less of a step makes no difference.
constexpr double shortest_share_at_limit = 0.02;

// Share of damping that acts on the speed at the end of a step, the rest on that at its beginning: half of it, which is
// of second order, or as much more as it takes lest speeds ring, where `damped` = step * damping / mass is beyond 2.
double implicit_share(double damped) { return damped > 2 ? 1 - 1 / damped : 0.5; }

}  // namespace

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

double lag_share(double step, double lag) { return step / (step + lag); }

double stribeck_share(double speed) {
  const double slow = speed / stribeck_speed;
  return std::exp(-slow * slow);
}

RobotStep::RobotStep(const Robot& robot_, const RobotRecording& recording_, const StartState& start,
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
  v = before = middle = next_ = dissipation = implicit = start.speed;
  seen = q;
  momentum.resize(n);
  friction.resize(n);
  drives.resize(robot.joints.size());
  for (std::vector<int>& joints : joints_by_tree(robot)) trees.push_back({std::move(joints), {}, {}, {}, {}, {}});
  lagging.setConstant(n, std::numeric_limits<double>::quiet_NaN());
}

// Mass matrix of the joints that move, and `data->qfrc_bias`: gravity and Coriolis forces.
void RobotStep::rigid_bodies() {
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

DriveTorque RobotStep::drive(Eigen::Index i, Eigen::Index row, double t, double h) {
  const JointSetup& stated = robot.joints[static_cast<std::size_t>(i)].setup;
  const JointPhysics& p = joint(i);
  DriveTorque torque;
  const double late = p[Property::delay] + p[Property::goal_clock];
  torque.goal = late == 0 ? recording.goal(row, i) : mean_goal(recording, i, row, t - late, h);
  // Positions are those of mid-step.
  seen[i] = std::clamp(seen[i], q[i] - p[Property::backlash], q[i] + p[Property::backlash]);
  const double gain = 1 + p[Property::torque_gain], kd = gain * stated.kd * (1 + p[Property::kd_error]);
  const double age = p[Property::reading_age];
  torque.stiffness = gain * stated.kp * (1 + p[Property::kp_error]);
  torque.told_damping = torque.damping = kd - torque.stiffness * age;
  torque.inertia = -kd * (age + p[Property::speed_age]);
  torque.limit = stated.limit * (1 - p[Property::torque_limit]);
  torque.constant = torque.stiffness * (torque.goal - seen[i] - p[Property::sensor_bias]);
  torque.told = torque.constant - torque.damping * middle[i];
  torque.saturated = torque.limit > 0 && std::abs(torque.told) > torque.limit;
  if (torque.saturated) {
    torque.constant = torque.told = std::copysign(torque.limit, torque.told);
    torque.damping = torque.inertia = 0;
  }
  if (p[Property::lag] > 0) {
    const double share = lag_share(h, p[Property::lag]);
    if (!std::isfinite(lagging[i])) lagging[i] = torque.told;
    torque.constant = (1 - share) * lagging[i] + share * torque.constant;
    torque.damping *= share;
    torque.inertia *= share;
  }
  return torque;
}

void RobotStep::restore(const State& state) {
  q = state.q;
  v = state.v;
  before = state.before;
  seen = state.seen;
  lagging = state.lagging;
  passed_ = state.passed;
}

void RobotStep::step(Eigen::Index row, double t, double h) {
  const double end = t + h;
  for (double left = h; left > shortest; left = end - t) t += substep(row, t, left);
}

double RobotStep::substep(Eigen::Index row, double t, double h) {
  start_ = state();
  stopped = -1;
  advance(row, t, h);
  const double share = share_until_rest();
  const double until_limit = share_until_limit();
  if (until_limit < share) {
    restore(start_);
    stopped = -1;
    advance(row, t, until_limit * h);
    return until_limit * h;
  }
  if (stopped < 0) return h;
  const int joint = stopped;
  if (share < smallest_share) {  // it is at rest already, within rounding
    start_.v[joint] = 0;
    restore(start_);
    advance(row, t, h);
    stopped = -1;
    return h;
  }
  restore(start_);
  advance(row, t, share * h);
  v[joint] = 0;
  passed_ = 0;  // speeds do not go on as they did
  return share * h;
}

// What the drive of a joint is told at this angle and speed, with its goal of the step that was just made.
double RobotStep::told_at(Eigen::Index i, double angle, double speed) const {
  const JointPhysics& p = joint(i);
  const DriveTorque& torque = drives[static_cast<std::size_t>(i)];
  const double reads = std::clamp(seen[i], angle - p[Property::backlash], angle + p[Property::backlash]);
  return torque.stiffness * (torque.goal - reads - p[Property::sensor_bias]) - torque.told_damping * speed;
}

// Of the step that was just made, until the first torque reaches its limit or leaves it; 1: none does.
double RobotStep::share_until_limit() const {
  double first = 1;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const double limit = drives[static_cast<std::size_t>(i)].limit;
    if (!(limit > 0)) continue;
    const double begin = told_at(i, start_.q[i], start_.v[i]), end = told_at(i, q[i], v[i]);
    for (const double at : {-limit, limit}) {
      const double share = (at - begin) / (end - begin);
      if (share > shortest_share_at_limit && share < 1 - shortest_share_at_limit) first = std::min(first, share);
    }
  }
  return first;
}

// Of the step that was just made, until the first joint that slips comes to rest; `stopped` is that joint.
double RobotStep::share_until_rest() {
  double first = 1;
  bool any = false;
  for (Eigen::Index i = 0; i < v.size(); ++i)
    any = any || (friction[i] > 0 && start_.v[i] != 0 && v[i] * start_.v[i] <= 0);
  if (!any) return 1;
  // Speeds if all went on slipping as they did.
  for (StepTree& tree : trees) {
    const auto size = static_cast<Eigen::Index>(tree.joints.size());
    Eigen::MatrixXd free_mass = mass(tree.joints, tree.joints);
    Eigen::VectorXd right = momentum(tree.joints);
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = tree.joints[static_cast<std::size_t>(r)];
      right[r] -= friction[i] * sign_of(start_.v[i]);
      if (friction[i] == 0 || start_.v[i] != 0) continue;
      free_mass.row(r).setZero();
      free_mass.col(r).setZero();
      free_mass(r, r) = 1;
      right[r] = 0;
    }
    const Eigen::VectorXd slipping = free_mass.llt().solve(right);
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = tree.joints[static_cast<std::size_t>(r)];
      if (friction[i] == 0 || start_.v[i] == 0 || slipping[r] * start_.v[i] >= 0) continue;
      const double share = start_.v[i] / (start_.v[i] - slipping[r]);
      if (share >= first) continue;
      first = share;
      stopped = static_cast<int>(i);
    }
  }
  return first;
}

// Tree by tree: the cost of a step grows with the number of joints, not with its third power.
void RobotStep::solve_friction() {
  for (StepTree& tree : trees) {
    tree.mass = mass(tree.joints, tree.joints);
    tree.momentum = momentum(tree.joints);
    tree.friction = friction(tree.joints);
    surefoot::solve_coupled_dry_friction(tree.mass, tree.momentum, tree.friction, tree.work, tree.speed);
    next_(tree.joints) = tree.speed;
  }
}

void RobotStep::advance(Eigen::Index row, double t, double h) {
  middle = passed_ > 0 ? Eigen::VectorXd(v + h / (2 * passed_) * (v - before)) : v;
  passed_ = h;
  before = v;
  q += h / 2 * v;
  rigid_bodies();
  const mjModel* m = model.get();
  momentum.noalias() = mass * v;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const JointPhysics& p = joint(i);
    const ModelJoint& model_joint = robot.joints[static_cast<std::size_t>(i)].model;
    const DriveTorque torque = drives[static_cast<std::size_t>(i)] = drive(i, row, t, h);
    const double spring = m->jnt_stiffness[model_joint.id] * (q[i] - m->qpos_spring[model_joint.position]);
    const double force = torque.constant + p[Property::constant_torque] -
                         p[Property::drag] * middle[i] * std::abs(middle[i]) - data->qfrc_bias[model_joint.dof] -
                         spring;
    const double inertia = p[Property::armature] + torque.inertia;
    mass(i, i) += inertia;
    dissipation[i] = p[Property::viscous] + torque.damping;
    implicit[i] = implicit_share(h * dissipation[i] / mass(i, i));
    momentum[i] += inertia * v[i] + h * (force - (1 - implicit[i]) * dissipation[i] * v[i]);
    mass(i, i) += h * implicit[i] * dissipation[i];
    friction[i] = h * (p[Property::coulomb] + p[Property::breakaway] * stribeck_share(middle[i]) +
                       p[Property::load_friction] * std::abs(torque.constant - torque.damping * middle[i]));
  }
  solve_friction();
  // Friction by load follows the torque, and that the speed, which turns where goals jump: not as it was extrapolated.
  bool by_load = false;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const DriveTorque& torque = drives[static_cast<std::size_t>(i)];
    const double share = joint(i)[Property::load_friction], damped = implicit[i] * next_[i] + (1 - implicit[i]) * v[i];
    friction[i] +=
        h * share *
        (std::abs(torque.constant - torque.damping * damped) - std::abs(torque.constant - torque.damping * middle[i]));
    by_load = by_load || share > 0;
  }
  if (by_load) solve_friction();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const DriveTorque& torque = drives[static_cast<std::size_t>(i)];
    const double damped = implicit[i] * next_[i] + (1 - implicit[i]) * v[i];  // the speed that damping acted on
    if (joint(i)[Property::lag] > 0) lagging[i] = torque.constant - torque.damping * damped;
  }
  v.swap(next_);
  q += h / 2 * v;
}

void RobotStep::read(Eigen::MatrixXd& readings, Eigen::Index row) const {
  for (Eigen::Index i = 0; i < q.size(); ++i) readings(row, i) = q[i] + joint(i)[Property::sensor_bias];
}

bool RobotStep::ran_away() const { return !(q.cwiseAbs().maxCoeff() < runaway); }

}  // namespace diagnose_robot
