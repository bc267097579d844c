#include <algorithm>
#include <cmath>

#include "diagnose_robot.hpp"
#include "findings.hpp"
#include "low_pass.hpp"
#include "simulate_robot.hpp"
#include "surefoot/core/rng.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

// Goals as the drives had them: held from row to row, half a row late on average, and as late as was found.
Motion with_late_goals(Motion motion, const RobotPhysics& physics) {
  if (motion.goal.size() == 0) return motion;
  const Eigen::MatrixXd goal = motion.goal;
  const Eigen::VectorXd& t = motion.time;
  const Eigen::Index rows = t.size();
  const double row = (t[rows - 1] - t[0]) / static_cast<double>(rows - 1);
  for (Eigen::Index j = 0; j < goal.cols(); ++j) {
    const JointPhysics& joint = physics[static_cast<std::size_t>(j)];
    const double late = row / 2 + joint[Property::delay] + joint[Property::lag];
    for (Eigen::Index k = rows - 1, before = k; k >= 0; --k) {
      while (before > 0 && t[before] > t[k] - late) --before;
      const Eigen::Index next = std::min(before + 1, rows - 1);
      const double share =
          next > before ? std::clamp((t[k] - late - t[before]) / (t[next] - t[before]), 0.0, 1.0) : 0.0;
      motion.goal(k, j) = goal(before, j) + share * (goal(next, j) - goal(before, j));
    }
  }
  return motion;
}

TorquePicture torque_picture(const Evidence& evidence, Eigen::Index joint, const RobotPhysics& physics) {
  constexpr Eigen::Index bins = 41;
  TorquePicture picture;
  const RobotJoint& at = evidence.robot.joints[static_cast<std::size_t>(joint)];
  picture.joint = at.setup.name;
  picture.unit = at.model.slides ? "N" : "N m";
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(bins, 3);
  double fastest = 1e-9;
  for (const Motion& motion : evidence.motions) fastest = std::max(fastest, motion.v.col(joint).cwiseAbs().maxCoeff());
  for (const Motion& motion : evidence.motions) {
    const RobotPhysics none(physics.size());
    const Eigen::MatrixXd rigid = torque_residual(evidence.robot, with_late_goals(motion, none), none);
    const Eigen::MatrixXd after = torque_residual(evidence.robot, with_late_goals(motion, physics), physics);
    for (Eigen::Index k = 0; k < rigid.rows(); ++k) {
      if (!std::isfinite(rigid(k, joint)) || !std::isfinite(after(k, joint))) continue;
      const auto bin = static_cast<Eigen::Index>((motion.v(k, joint) / fastest + 1) / 2 * (bins - 1e-6));
      sum.row(bin) += Eigen::RowVector3d(1, rigid(k, joint), after(k, joint));
    }
  }
  picture.speed = Eigen::VectorXd::LinSpaced(bins, -fastest, fastest);
  picture.rigid = (sum.col(0).array() > 0).select(sum.col(1).array() / sum.col(0).array().max(1), std::nan(""));
  picture.after = (sum.col(0).array() > 0).select(sum.col(2).array() / sum.col(0).array().max(1), std::nan(""));
  return picture;
}

}  // namespace

void draw_worst(const Evidence& evidence, RobotDiagnosis& d) {
  constexpr std::size_t most = 4;  // joints that are drawn
  std::vector<std::size_t> by_error(d.joints.size());
  for (std::size_t j = 0; j < by_error.size(); ++j) by_error[j] = j;
  std::ranges::sort(by_error, [&](std::size_t a, std::size_t b) {
    const auto size = [&](std::size_t j) {
      return d.torque_driven ? d.joints[j].nominal / std::max(1e-9, d.joints[j].torque) : d.joints[j].nominal;
    };
    return size(a) > size(b);
  });
  by_error.resize(std::min(most, by_error.size()));
  for (const std::size_t j : by_error)
    d.torques.push_back(torque_picture(evidence, static_cast<Eigen::Index>(j), d.physics));
  const RobotRecording& recording = evidence.recordings.front();
  const Motion& motion = evidence.motions.front();
  const Eigen::MatrixXd nominal =
      d.torque_driven ? torque_residual(evidence.robot, motion, RobotPhysics(d.physics.size()))
                      : simulate_robot(evidence.robot, recording, start_of(motion), evidence.robot.nominal);
  const Eigen::MatrixXd after = d.torque_driven
                                    ? torque_residual(evidence.robot, motion, d.physics)
                                    : simulate_robot(evidence.robot, recording, d.starts.front(), d.physics);
  for (const std::size_t j : by_error) {
    const auto c = static_cast<Eigen::Index>(j);
    d.curves.push_back({d.joints[j].joint, recording.time,
                        d.torque_driven ? Eigen::VectorXd() : Eigen::VectorXd(recording.angle.col(c)), nominal.col(c),
                        after.col(c)});
  }
}

Eigen::VectorXd noise_by_joint(const Evidence& evidence, const RobotPhysics& physics, std::uint64_t seed) {
  const auto joints = static_cast<Eigen::Index>(evidence.robot.joints.size());
  Eigen::VectorXd square = Eigen::VectorXd::Zero(joints);
  surefoot::Rng rng(seed);
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) {
    RobotRecording noisy = evidence.recordings[r];
    Eigen::VectorXd angle(joints), torque = Eigen::VectorXd::Zero(joints);
    for (Eigen::Index j = 0; j < joints; ++j) {
      angle[j] = noise_of(noisy.angle.col(j));
      if (is_torque_driven(evidence)) torque[j] = noise_of(noisy.torque.col(j));
    }
    Eigen::VectorXd one = angle.cwiseAbs2();
    if (is_torque_driven(evidence)) {
      for (Eigen::Index j = 0; j < joints; ++j) {
        for (Eigen::Index k = 0; k < noisy.time.size(); ++k) {
          noisy.angle(k, j) += angle[j] * rng.normal();
          noisy.torque(k, j) += torque[j] * rng.normal();
        }
      }
      const Motion& motion = evidence.motions[r];
      const Eigen::MatrixXd change =
          low_passed(motion, torque_residual(evidence.robot, smooth(noisy, {motion.half_window}), physics) -
                                 torque_residual(evidence.robot, motion, physics));
      for (Eigen::Index j = 0; j < joints; ++j) {
        double sum = 0, rows = 0;
        for (const double x : change.col(j)) {
          if (!std::isfinite(x)) continue;
          sum += x * x;
          rows += 1;
        }
        one[j] = sum / std::max(1.0, rows);
      }
    }
    square += one / static_cast<double>(evidence.recordings.size());
  }
  return square.cwiseSqrt();
}

}  // namespace diagnose_robot
