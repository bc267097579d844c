#include "torque_residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inverse_dynamics.hpp"
#include "robot_step.hpp"

namespace diagnose_robot {
namespace {

constexpr double resting_share = 0.03;  // of the root mean square speed: what smoothing leaves of a reversal
constexpr double times_noise = 3;       // of speeds: a joint that seems to move slower may as well stand

double rms(const Eigen::Ref<const Eigen::VectorXd>& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, x.size())));
}

// Whether the joint reverses within the window of a row: its smoothed friction and acceleration are mixtures of both
// sides.
bool reverses_about(const Motion& motion, Eigen::Index row, Eigen::Index joint) {
  const auto reverses = [&](Eigen::Index k) { return motion.v(k, joint) * motion.v(row, joint) < 0; };
  for (Eigen::Index k = row; k-- > 0 && motion.time[row] - motion.time[k] < motion.reach;) {
    if (reverses(k)) return true;
  }
  for (Eigen::Index k = row + 1; k < motion.v.rows() && motion.time[k] - motion.time[row] < motion.reach; ++k) {
    if (reverses(k)) return true;
  }
  return false;
}

}  // namespace

Eigen::MatrixXd rigid_body_torque(const Robot& robot, const Motion& motion, const RobotPhysics& physics) {
  const ModelPointer model = model_with_bodies(robot, physics);
  const DataPointer data(mj_makeData(model.get()));
  Eigen::MatrixXd torque(motion.q.rows(), motion.q.cols());
  Eigen::VectorXd bias(motion.q.cols()), at;
  for (Eigen::Index j = 0; j < bias.size(); ++j) bias[j] = physics[static_cast<std::size_t>(j)][Property::sensor_bias];
  for (Eigen::Index k = 0; k < motion.q.rows(); ++k) {
    rigid_body_torque(robot, model.get(), data.get(), motion.q.row(k).transpose() - bias, motion.v.row(k),
                      motion.a.row(k), at);
    torque.row(k) = at;
  }
  return torque;
}

Eigen::VectorXd resting_speed(const Motion& motion) {
  Eigen::VectorXd speed(motion.v.cols());
  for (Eigen::Index j = 0; j < speed.size(); ++j)
    speed[j] = std::max(resting_share * rms(motion.v.col(j)), times_noise * motion.speed_noise[j]);
  return speed;
}

Eigen::MatrixXd drive_torque(const Robot& robot, const Motion& motion) {
  if (robot.setup.drive == DriveKind::torque) return motion.torque;
  Eigen::MatrixXd torque(motion.q.rows(), motion.q.cols());
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const JointSetup& drive = robot.joints[j].setup;
    const auto c = static_cast<Eigen::Index>(j);
    const double limit = drive.limit > 0 ? drive.limit : std::numeric_limits<double>::infinity();
    torque.col(c) = (drive.kp * (motion.goal.col(c) - motion.q.col(c)) - drive.kd * motion.v.col(c))
                        .cwiseMax(-limit)
                        .cwiseMin(limit);
  }
  return torque;
}

Eigen::MatrixXd arrived_torque(const Robot& robot, const Motion& motion, const RobotPhysics& physics) {
  Eigen::MatrixXd torque = drive_torque(robot, motion);
  if (robot.setup.drive != DriveKind::torque) return torque;
  for (Eigen::Index j = 0; j < torque.cols(); ++j) {
    const double late = motion.torque_late + physics[static_cast<std::size_t>(j)][Property::delay];
    if (late == 0) continue;
    const Eigen::VectorXd told = torque.col(j);
    Eigen::Index before = 0;
    for (Eigen::Index k = 0; k < told.size(); ++k) {
      const double sent = motion.time[k] - late;
      while (before + 2 < told.size() && motion.time[before + 1] <= sent) ++before;
      const double share = (sent - motion.time[before]) / (motion.time[before + 1] - motion.time[before]);
      torque(k, j) = share < 0 ? std::nan("") : (1 - share) * told[before] + share * told[before + 1];
    }
  }
  return torque;
}

double load_factor(const JointPhysics& physics, double speed, double torque) {
  constexpr double most = 0.95;  // a drive that loses all of its torque to friction does not move
  return 1 / (1 - std::min(most, physics[Property::load_friction]) * sign_of(speed) * sign_of(torque));
}

// Recorded less expected reading: no scale makes this small by itself.
// Friction by load goes with the torque that the drive gives, of which it is itself a part; see load_factor().
Eigen::MatrixXd torque_residual(const Robot& robot, const Motion& motion, const RobotPhysics& physics) {
  Eigen::MatrixXd needed = rigid_body_torque(robot, motion, physics);
  const Eigen::VectorXd rest = resting_speed(motion);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    const JointPhysics& p = physics[j];
    const int before = robot.joints[j].before;
    for (Eigen::Index k = 0; k < needed.rows(); ++k) {
      const double v = motion.v(k, c);
      const double dry = p[Property::coulomb] + p[Property::breakaway] * stribeck_share(v);
      needed(k, c) += dry * sign_of(v) + p[Property::viscous] * v + p[Property::drag] * v * std::abs(v) +
                      p[Property::armature] * motion.a(k, c) - p[Property::constant_torque];
      if (before < 0) continue;
      const double sum = v + motion.v(k, before);
      const double pair = p[Property::pair_coulomb] * sign_of(sum) + p[Property::pair_viscous] * sum +
                          p[Property::pair_armature] * (motion.a(k, c) + motion.a(k, before));
      needed(k, c) += pair;
      needed(k, before) += pair;
    }
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    for (Eigen::Index k = 0; k < needed.rows(); ++k)
      needed(k, c) *= (1 + physics[j][Property::reading_scale]) * load_factor(physics[j], motion.v(k, c), needed(k, c));
  }
  Eigen::MatrixXd residual = arrived_torque(robot, motion, physics) - needed;
  for (Eigen::Index c = 0; c < residual.cols(); ++c) {
    for (Eigen::Index k = 0; k < residual.rows(); ++k) {
      const bool inside = k >= motion.edge && k < residual.rows() - motion.edge;
      if (!inside || std::abs(motion.v(k, c)) < rest[c] || reverses_about(motion, k, c)) residual(k, c) = std::nan("");
    }
  }
  return residual;
}

}  // namespace diagnose_robot
