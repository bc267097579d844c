#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "derivatives.hpp"
#include "inverse_dynamics.hpp"
#include "robot_step.hpp"

namespace diagnose_robot {
namespace {

constexpr double shortest = 1e-12;         // [s]: rounding
constexpr double delay_difference = 1e-3;  // [s] of the goal's mean, which is piecewise linear in the delay

// Joints that move each other, and how their motion changes with each entry and with the start: place in the tree x
// place in `entries`, then angle and speed of each place.
struct Tree {
  std::vector<int> joints;
  std::vector<std::size_t> entries;
  std::vector<std::vector<std::pair<Eigen::Index, Property>>> own;  // by place: columns of entries of this joint
  Eigen::MatrixXd angle, speed, before, middle, seen, lagging;
  Eigen::MatrixXd constant, damping, inertia;    // of drives, in this step
  Eigen::MatrixXd by_angle, by_speed, by_entry;  // of inverse dynamics
  Eigen::MatrixXd mass, right;
};

// State of the step that its end overwrites.
struct Before {
  Eigen::VectorXd seen, lagging, speed, told;
};

struct Tangent {
  const Robot& robot;
  const std::vector<PhysicsEntry>& entries;
  RobotStep& now;
  Before then;
  std::vector<Tree> trees;
  double h = 0;
  double time = 0;
  Eigen::Index row = 0;
  int stopped = -1;              // joint that the substep before ended for
  Eigen::VectorXd acceleration;  // in that substep
  double passed = 0;             // [s], length of the substep before

  Tangent(const Robot& robot_, const std::vector<PhysicsEntry>& entries_, RobotStep& step)
      : robot(robot_), entries(entries_), now(step), trees(joints_by_tree(robot_).size()) {
    const auto joints = joints_by_tree(robot);
    for (std::size_t t = 0; t < trees.size(); ++t) {
      Tree& tree = trees[t];
      tree.joints = joints[t];
      for (std::size_t e = 0; e < entries.size(); ++e) {
        if (std::ranges::find(tree.joints, entries[e].joint) != tree.joints.end()) tree.entries.push_back(e);
      }
      const auto rows = static_cast<Eigen::Index>(tree.joints.size()),
                 from = static_cast<Eigen::Index>(tree.entries.size()), cols = from + 2 * rows;
      for (Eigen::MatrixXd* matrix :
           {&tree.angle, &tree.speed, &tree.before, &tree.seen, &tree.lagging, &tree.by_entry})
        matrix->setZero(rows, cols);
      tree.mass.setZero(rows, rows);
      tree.own.resize(tree.joints.size());
      for (std::size_t c = 0; c < tree.entries.size(); ++c) {
        const PhysicsEntry& entry = entries[tree.entries[c]];
        const auto place = std::ranges::find(tree.joints, entry.joint) - tree.joints.begin();
        const auto column = static_cast<Eigen::Index>(c);
        tree.own[static_cast<std::size_t>(place)].emplace_back(column, entry.property);
        if (entry.property == Property::sensor_bias) tree.angle(place, column) = tree.seen(place, column) = -1;
      }
      for (Eigen::Index r = 0; r < rows; ++r) {
        tree.angle(r, from + r) = tree.seen(r, from + r) = 1;
        tree.speed(r, from + rows + r) = tree.before(r, from + rows + r) = 1;
      }
    }
    then.told.setConstant(now.q.size(), std::numeric_limits<double>::quiet_NaN());
  }

  void step(Eigen::Index row_, double t, double length) {
    row = row_;
    const double end = t + length;
    for (double left = length; left > shortest; left = end - t) {
      time = t;
      then.seen = now.seen;
      then.lagging = now.lagging;
      then.speed = now.v;
      h = now.substep(row, t, left);
      turn_friction();
      for (Tree& tree : trees) advance(tree);
      for (Eigen::Index i = 0; i < now.q.size(); ++i) then.told[i] = now.drives[static_cast<std::size_t>(i)].told;
      stopped = now.stopped;
      passed = stopped >= 0 ? 0 : h;
      if (stopped >= 0) acceleration = (now.v - then.speed) / h;
      t += h;
    }
  }

  // A joint that comes to rest earlier has its friction turned earlier: what the jump of accelerations makes of that.
  void turn_friction() {
    if (stopped < 0) return;
    const double braking = acceleration[stopped];
    const Eigen::VectorXd after = (now.v - then.speed) / h;
    for (Tree& tree : trees) {
      const auto place = std::ranges::find(tree.joints, stopped);
      if (place == tree.joints.end() || braking == 0) continue;
      const Eigen::RowVectorXd earlier = tree.speed.row(place - tree.joints.begin()) / braking;
      for (std::size_t r = 0; r < tree.joints.size(); ++r) {
        const int j = tree.joints[r];
        tree.speed.row(static_cast<Eigen::Index>(r)) += (after[j] - acceleration[j]) * earlier;
      }
    }
  }

  // What the drive of joint i sees and gives.
  void derive_drive(Tree& tree, Eigen::Index r, Eigen::Index i) const {
    const JointPhysics& p = now.joint(i);
    const JointSetup& stated = robot.joints[static_cast<std::size_t>(i)].setup;
    const DriveTorque& drive = now.drives[static_cast<std::size_t>(i)];
    const double angle = now.q[i] - h / 2 * now.v[i];
    const double side = sign_of(then.seen[i] - angle);
    const bool touches = std::abs(then.seen[i] - angle) > p[Property::backlash];
    if (touches) tree.seen.row(r) = tree.angle.row(r);
    const double gain = 1 + p[Property::torque_gain], kp = drive.stiffness;
    const double kd = gain * stated.kd * (1 + p[Property::kd_error]), age = p[Property::reading_age],
                 of_speed = age + p[Property::speed_age];
    const double error = drive.goal - now.seen[i] - p[Property::sensor_bias];
    const double share = lag_share(h, p[Property::lag]);
    const double follows = drive.saturated ? 0 : share;
    for (const auto& [c, property] : tree.own[static_cast<std::size_t>(r)]) {
      if (property == Property::backlash && touches) tree.seen(r, c) += side;
    }
    tree.constant.row(r) = (1 - share) * tree.lagging.row(r) - follows * kp * tree.seen.row(r);
    tree.damping.row(r).setZero();
    tree.inertia.row(r).setZero();
    for (const auto& [c, property] : tree.own[static_cast<std::size_t>(r)]) {
      double &constant = tree.constant(r, c), &damping = tree.damping(r, c), &inertia = tree.inertia(r, c);
      if (property == Property::kp_error) constant += follows * gain * stated.kp * error;
      if (property == Property::kp_error) damping = -follows * gain * stated.kp * age;
      if (property == Property::torque_gain) constant += follows * kp / gain * error;
      if (property == Property::torque_gain) damping = follows * (kd - kp * age) / gain;
      if (property == Property::torque_gain) inertia = -follows * kd * of_speed / gain;
      if (property == Property::kd_error) damping = follows * gain * stated.kd;
      if (property == Property::kd_error) inertia = -follows * gain * stated.kd * of_speed;
      if (property == Property::reading_age) damping = -follows * kp;
      if (property == Property::reading_age || property == Property::speed_age) inertia = -follows * kd;
      if (property == Property::sensor_bias) constant -= follows * kp;
      if (property == Property::torque_limit && drive.saturated) constant -= share * sign_of(drive.told) * stated.limit;
      if (property == Property::lag) constant += by_lag(i, drive);
      if (property == Property::delay || property == Property::goal_clock) constant += follows * kp * goal_by_delay(i);
    }
  }

  double by_lag(Eigen::Index i, const DriveTorque& drive) const {
    const double lag = now.joint(i)[Property::lag];
    if (!std::isfinite(then.told[i])) return 0;
    if (lag > 0) return -h / ((h + lag) * (h + lag)) * (drive.told - then.lagging[i]);
    return -(drive.told - then.told[i]) / h;
  }

  double goal_by_delay(Eigen::Index i) const {
    const double from = time - now.joint(i)[Property::delay] - now.joint(i)[Property::goal_clock];
    return (mean_goal(now.recording, i, row, from - delay_difference, h) - mean_goal(now.recording, i, row, from, h)) /
           delay_difference;
  }

  // Momentum that forces at joint i add; `slips`: its direction, 0 if it sticks.
  void derive_forces(Tree& tree, Eigen::Index r, Eigen::Index i, double slips) const {
    const JointPhysics& p = now.joint(i);
    const DriveTorque& drive = now.drives[static_cast<std::size_t>(i)];
    const double middle = now.middle[i], share = now.implicit[i];
    const double damped = share * now.v[i] + (1 - share) * then.speed[i];  // the speed that damping acts on
    const double given = drive.constant - drive.damping * middle;
    const double load = slips * h * p[Property::load_friction] * sign_of(given);
    const double stribeck = stribeck_share(middle);
    const double stretch = now.q[i] - h / 2 * now.v[i] - rest_of_spring(robot, static_cast<std::size_t>(i));
    const double by_middle = -2 * p[Property::drag] * std::abs(middle) +
                             slips * p[Property::breakaway] * 2 * middle / (stribeck_speed * stribeck_speed) * stribeck;
    auto right = tree.right.row(r);
    right += (h - load) * tree.constant.row(r) + (h * by_middle + load * drive.damping) * tree.middle.row(r) -
             h * (1 - share) * now.dissipation[i] * tree.speed.row(r) +
             (load * middle - h * damped) * tree.damping.row(r) - (now.v[i] - then.speed[i]) * tree.inertia.row(r);
    for (const auto& [c, property] : tree.own[static_cast<std::size_t>(r)]) {
      double& entry = right[c];
      if (property == Property::coulomb) entry -= slips * h;
      if (property == Property::viscous) entry -= h * damped;
      if (property == Property::breakaway) entry -= slips * h * stribeck;
      if (property == Property::load_friction) entry -= slips * h * std::abs(given);
      if (property == Property::drag) entry -= h * middle * std::abs(middle);
      if (property == Property::armature) entry -= now.v[i] - then.speed[i];
      if (property == Property::constant_torque) entry += h;
      if (property == Property::stiffness) entry -= h * stretch;
    }
  }

  void advance(Tree& tree) const {
    const auto size = static_cast<Eigen::Index>(tree.joints.size());
    tree.middle = tree.speed;
    if (passed > 0) tree.middle += h / (2 * passed) * (tree.speed - tree.before);
    tree.before = tree.speed;
    tree.angle += h / 2 * tree.speed;
    tree.constant.resize(size, tree.angle.cols());
    tree.damping.resize(size, tree.angle.cols());
    tree.inertia.resize(size, tree.angle.cols());
    for (Eigen::Index r = 0; r < size; ++r) {
      for (Eigen::Index k = 0; k < size; ++k)
        tree.mass(r, k) = now.mass(tree.joints[static_cast<std::size_t>(r)], tree.joints[static_cast<std::size_t>(k)]);
      derive_drive(tree, r, tree.joints[static_cast<std::size_t>(r)]);
    }
    tree.right.noalias() = tree.mass * tree.speed;
    tree.right.noalias() -= h * (tree.by_angle * tree.angle);
    tree.right.noalias() -= h * (tree.by_speed * tree.middle);
    tree.right.leftCols(tree.by_entry.cols()) -= h * tree.by_entry;
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = tree.joints[static_cast<std::size_t>(r)];
      tree.right.row(r) -= h * now.implicit[i] * now.dissipation[i] * tree.speed.row(r);  // not a part of the momentum
      derive_forces(tree, r, i, sign_of(now.v[i]));
    }
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = tree.joints[static_cast<std::size_t>(r)];
      if (now.v[i] != 0 || now.friction[i] == 0) continue;
      tree.mass.row(r).setZero();
      tree.mass.col(r).setZero();
      tree.mass(r, r) = 1;
      tree.right.row(r).setZero();
    }
    tree.speed = tree.mass.llt().solve(tree.right);
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = tree.joints[static_cast<std::size_t>(r)];
      const double share = now.implicit[i], damping = now.drives[static_cast<std::size_t>(i)].damping;
      tree.lagging.row(r) = tree.constant.row(r) - share * damping * tree.speed.row(r) -
                            (1 - share) * damping * tree.before.row(r) -
                            (share * now.v[i] + (1 - share) * then.speed[i]) * tree.damping.row(r);
    }
    tree.angle += h / 2 * tree.speed;
  }

  void read(std::vector<JointDerivatives>& result, Eigen::Index to) const {
    for (const Tree& tree : trees) {
      for (std::size_t r = 0; r < tree.joints.size(); ++r) {
        JointDerivatives& one = result[static_cast<std::size_t>(tree.joints[r])];
        Eigen::MatrixXd& by = one.by;
        const auto angle = tree.angle.row(static_cast<Eigen::Index>(r));
        by.row(to) = angle.head(by.cols());
        one.by_start.row(to) = angle.tail(one.by_start.cols());
        for (const auto& [c, property] : tree.own[r]) {
          if (property == Property::sensor_bias) by(to, c) += 1;
        }
      }
    }
  }
};

}  // namespace

std::vector<JointDerivatives> simulation_derivatives(const Robot& robot, const RobotRecording& recording,
                                                     const StartState& start, const RobotPhysics& physics,
                                                     const std::vector<PhysicsEntry>& entries) {
  RobotStep step(robot, recording, start, physics);
  Tangent tangent(robot, entries, step);
  InverseDynamics dynamics(robot, physics, entries);
  const Eigen::Index rows = recording.time.size();
  std::vector<JointDerivatives> result(robot.joints.size());
  for (const Tree& tree : tangent.trees) {
    for (const int j : tree.joints) {
      result[static_cast<std::size_t>(j)].entries = tree.entries;
      JointDerivatives& one = result[static_cast<std::size_t>(j)];
      one.by.setConstant(rows, static_cast<Eigen::Index>(tree.entries.size()),
                         std::numeric_limits<double>::quiet_NaN());
      one.by_start.setConstant(rows, 2 * static_cast<Eigen::Index>(tree.joints.size()),
                               std::numeric_limits<double>::quiet_NaN());
    }
  }
  const double wanted = simulation_step(robot, recording);
  tangent.read(result, 0);
  Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(step.q.size());
  for (Eigen::Index k = 0; k + 1 < rows; ++k) {
    const double period = recording.time[k + 1] - recording.time[k];
    const auto steps = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::lround(period / wanted)));
    const double h = period / static_cast<double>(steps);
    dynamics.derive(step.q, step.v, acceleration, true);
    for (std::size_t t = 0; t < tangent.trees.size(); ++t) {
      tangent.trees[t].by_angle = dynamics.trees[t].by_angle;
      tangent.trees[t].by_speed = dynamics.trees[t].by_speed;
      tangent.trees[t].by_entry = dynamics.trees[t].by_entry;
    }
    const Eigen::VectorXd before = step.v;
    for (Eigen::Index s = 0; s < steps; ++s) tangent.step(k, recording.time[k] + static_cast<double>(s) * h, h);
    acceleration = (step.v - before) / period;
    if (step.ran_away()) return result;
    tangent.read(result, k + 1);
  }
  return result;
}

}  // namespace diagnose_robot
