#include "torque_hold.hpp"

#include "choose_terms.hpp"

namespace diagnose_robot {
namespace {

double half_row(const RobotRecording& recording) { return recording.row_period() / 2; }

// The criterion with all that groups may have, and commands late by this at all joints.
double criterion_with_delay(const Evidence& evidence, LinearModel model, double late) {
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    if (evidence.terms[t].property != Property::delay) continue;
    const auto at = static_cast<Eigen::Index>(t);
    model.low[at] = model.high[at] = late;  // one term, of all joints
  }
  return fit_linear(model, model.of_groups).criterion;
}

}  // namespace

double evidence_for_held_torques(const Evidence& evidence) {
  if (evidence.robot.setup.drive != DriveKind::torque) return 0;
  const Eigen::VectorXd theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(evidence.terms.size()));
  RigidCache cache;
  const LinearModel model = linearize(evidence, theta, evidence.starts, errors_of(evidence, evidence.robot.nominal), cache);
  const double late = half_row(evidence.recordings.front());
  return criterion_with_delay(evidence, model, 0) - criterion_with_delay(evidence, model, late);
}

bool hold_torques(Evidence& evidence) {
  const bool held = evidence_for_held_torques(evidence) > ChoiceCriteria().needed;
  for (std::size_t r = 0; r < evidence.motions.size(); ++r) {
    RobotRecording& recording = evidence.recordings[r];
    evidence.motions[r].torque_late = recording.torque_late = held ? half_row(recording) : 0;
  }
  return held;
}

}  // namespace diagnose_robot
