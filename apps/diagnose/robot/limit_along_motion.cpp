#include "limit_along_motion.hpp"

#include <algorithm>
#include <cmath>

#include "robot_step.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

struct ToldAndNeeded {
  std::vector<double> told, needed;  // [N m]
};

void add_rows(const Evidence& evidence, const RobotPhysics& physics, std::size_t r, Eigen::Index joint,
              ToldAndNeeded& rows) {
  const RobotRecording& recording = evidence.recordings[r];
  const Motion& motion = evidence.motions[r];
  const auto j = static_cast<std::size_t>(joint);
  const JointSetup& drive = evidence.robot.joints[j].setup;
  const JointPhysics& p = physics[j];
  const Eigen::VectorXd needed =
      (drive_torque(evidence.robot, motion) - torque_residual(evidence.robot, motion, physics)).col(joint);
  const double period = recording.row_period(), gain = 1 + p[Property::torque_gain];
  for (Eigen::Index k = 0; k < needed.size(); ++k) {
    if (!std::isfinite(needed[k])) continue;
    const double from = recording.time[k] - p[Property::delay] - period / 2;  // the motion was smoothed to both sides
    const double error = mean_goal(recording, joint, k, from, period) - motion.q(k, joint);
    rows.told.push_back(gain * (drive.kp * (1 + p[Property::kp_error]) * error -
                                drive.kd * (1 + p[Property::kd_error]) * motion.v(k, joint)));
    rows.needed.push_back(needed[k]);
  }
}

double square_with(const ToldAndNeeded& rows, double limit) {
  double sum = 0;
  for (std::size_t k = 0; k < rows.told.size(); ++k)
    sum += std::pow(rows.needed[k] - std::clamp(rows.told[k], -limit, limit), 2);
  return sum;
}

}  // namespace

std::vector<double> limits_along_motion(const Evidence& evidence, const RobotPhysics& physics, int joint) {
  constexpr std::size_t most = 3;    // limits that are returned
  constexpr double narrower = 1.2;   // times the next limit: nearer ones lead to the same fit
  constexpr double smallest = 0.01;  // of the largest torque: a drive that gives less gives none
  constexpr double rarest = 0.002;   // of the rows: a limit that fewer reach shows nowhere
  ToldAndNeeded rows;
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) add_rows(evidence, physics, r, joint, rows);
  if (rows.told.empty()) return {};
  std::vector<double> sizes = rows.told;
  for (double& size : sizes) size = std::abs(size);
  std::ranges::sort(sizes);
  struct Candidate {
    double limit = 0, square = 0;
  };
  std::vector<Candidate> candidates;
  const double least = smallest * sizes.back();
  for (double limit = sizes[static_cast<std::size_t>((1 - rarest) * static_cast<double>(sizes.size() - 1))];
       limit > least; limit /= narrower)
    candidates.push_back({limit, square_with(rows, limit)});
  const double unlimited = square_with(rows, sizes.back());
  std::erase_if(candidates, [&](const Candidate& one) { return one.square >= unlimited; });
  std::ranges::stable_sort(candidates, {}, &Candidate::square);
  std::vector<double> result;
  for (std::size_t i = 0; i < std::min(most, candidates.size()); ++i) result.push_back(candidates[i].limit);
  return result;
}

}  // namespace diagnose_robot
