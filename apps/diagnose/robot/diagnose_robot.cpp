#include "diagnose_robot.hpp"

#include <algorithm>
#include <cmath>

#include "findings.hpp"
#include "numerical_error.hpp"
#include "starts.hpp"

namespace diagnose_robot {
namespace {

RobotPhysics physics_at(const Evidence& evidence, const Eigen::VectorXd& theta) {
  return physics_of(evidence.terms, theta, evidence.robot.nominal);
}

struct HeldOut {
  Eigen::VectorXd by_joint;
  std::vector<double> before, after;  // by block
};

// Each block with sizes that the other blocks alone determine.
HeldOut held_out_errors(const Evidence& evidence, const SearchResult& found, const Eigen::MatrixXd& nominal) {
  const auto blocks = static_cast<std::size_t>(evidence.blocks);
  const auto fold = surefoot::map(
      evidence.threads, blocks,
      [&](std::size_t b) {
        const LinearFit fit = fit_linear(found.linear, found.set, static_cast<int>(b));
        const Eigen::MatrixXd errors = errors_of(evidence, physics_at(evidence, found.theta + fit.change),
                                                 moved_starts(found.linear, found.starts, fit.change));
        return rms_by_joint(evidence, errors, static_cast<int>(b));
      },
      evidence.stop);
  HeldOut result;
  result.by_joint = Eigen::VectorXd::Zero(nominal.cols());
  for (std::size_t b = 0; b < blocks; ++b) {
    result.by_joint += fold[b].cwiseAbs2() / static_cast<double>(blocks);
    result.after.push_back(overall(evidence, fold[b]));
    result.before.push_back(overall(evidence, rms_by_joint(evidence, nominal, static_cast<int>(b))));
  }
  result.by_joint = result.by_joint.cwiseSqrt();
  return result;
}

}  // namespace

surefoot::Verdict verdict_of(std::size_t effects, std::size_t calibrated, double after, double noise, bool complete,
                             const VerdictCriteria& criteria) {
  if (!complete) return surefoot::Verdict::unfinished;
  if (std::isfinite(noise) && noise > 0 && after > criteria.beyond_noise * noise) return surefoot::Verdict::unexplained;
  if (effects > 0) return surefoot::Verdict::missing_physics;
  return calibrated > 0 ? surefoot::Verdict::parameters_only : surefoot::Verdict::adequate;
}

RobotDiagnosis refuse_log(const Evidence& evidence, const std::vector<surefoot::LogFault>& faults) {
  RobotDiagnosis d;
  d.torque_driven = is_torque_driven(evidence);
  d.error_unit = d.torque_driven ? "1" : "rad";
  d.physics = evidence.robot.nominal;
  d.starts = evidence.starts;
  const Eigen::VectorXd nominal = rms_by_joint(evidence, errors_of(evidence, evidence.robot.nominal));
  d.textbook = d.nominal = d.after = d.held_out = overall(evidence, nominal);
  d.noise = d.replayed = std::nan("");
  d.common.model = evidence.robot.model.file;
  d.common.verdict = surefoot::Verdict::unexplained;
  d.common.held_out_before = d.common.held_out_after = d.nominal;
  for (const surefoot::LogFault& fault : faults)
    d.common.sentence +=
        (d.common.sentence.empty() ? "" : "; ") + fault.sentence + "; " + fault.cure + ", or run again with --repair";
  return d;
}

void hold_out(const Evidence& test, RobotDiagnosis& d) {
  const Eigen::MatrixXd nominal = errors_of(test, test.robot.nominal),
                        after = errors_of(test, d.physics, fitted_starts(test, d.physics));
  const Eigen::VectorXd by_joint = rms_by_joint(test, after);
  d.held_out = overall(test, by_joint);
  d.common.held_out.clear();
  d.common.per_recording.clear();
  for (const RobotRecording& recording : test.recordings) d.common.held_out.push_back(recording.name);
  for (int b = 0; b < test.blocks; ++b) {
    const std::string name = test.recordings.size() == 1 ? "block " + std::to_string(b + 1)
                                                         : test.recordings[static_cast<std::size_t>(b)].name;
    const double one = overall(test, rms_by_joint(test, after, b));
    d.common.per_recording.push_back({name, overall(test, rms_by_joint(test, nominal, b)), one, one, 0, false});
  }
  for (std::size_t j = 0; j < d.joints.size(); ++j) d.joints[j].held_out = by_joint[static_cast<Eigen::Index>(j)];
  d.common.held_out_before = overall(test, rms_by_joint(test, nominal));
  d.common.held_out_after = d.held_out;
  d.common.noise_ratio = d.noise > 0 ? d.held_out / d.noise : std::nan("");
  conclude(test, d);
}

RobotDiagnosis diagnose_robot(const Evidence& evidence, const Progress& progress) {
  const SearchResult found = search_terms(evidence, progress);
  const std::size_t joints = evidence.robot.joints.size();
  RobotDiagnosis d;
  d.torque_driven = is_torque_driven(evidence);
  d.error_unit = d.torque_driven ? "1" : "rad";
  d.common.complete = found.complete;
  d.physics = physics_at(evidence, found.theta);
  d.starts = found.starts;
  const Eigen::MatrixXd textbook = errors_of(evidence, RobotPhysics(joints)),
                        nominal = errors_of(evidence, evidence.robot.nominal);
  const Eigen::VectorXd by_textbook = rms_by_joint(evidence, textbook), by_nominal = rms_by_joint(evidence, nominal),
                        by_after = rms_by_joint(evidence, found.errors);
  const HeldOut held_out = held_out_errors(evidence, found, nominal);
  Eigen::VectorXd noise = noise_by_joint(evidence, d.physics, 1);
  const Eigen::VectorXd method = d.torque_driven ? smoothing_error(evidence, d.physics) : found.numerical;
  if (method.size() > 0) noise = (noise.cwiseAbs2() + method.cwiseAbs2()).cwiseSqrt();  // no method is nearer
  d.textbook = overall(evidence, by_textbook);
  d.nominal = overall(evidence, by_nominal);
  d.after = overall(evidence, by_after);
  d.held_out = overall(evidence, held_out.by_joint);
  d.noise = overall(evidence, noise);
  for (std::size_t j = 0; j < joints; ++j) {
    const RobotJoint& joint = evidence.robot.joints[j];
    const auto c = static_cast<Eigen::Index>(j);
    const std::string unit = d.torque_driven ? (joint.model.slides ? "N" : "N m") : joint.model.slides ? "m" : "rad";
    d.joints.push_back({joint.setup.name, evidence.robot.setup.groups[static_cast<std::size_t>(joint.group)].name, unit,
                        by_textbook[c], by_nominal[c], by_after[c], held_out.by_joint[c], noise[c],
                        evidence.scales[j].reading});
    d.common.channels.push_back(
        {joint.setup.angle.name, unit, by_textbook[c], by_nominal[c], by_after[c], noise[c], 0});
  }
  surefoot::Diagnosis& common = d.common;
  common.model = evidence.robot.model.file;
  for (const RobotRecording& recording : evidence.recordings) common.fit.push_back(recording.name);
  common.held_out = common.fit;
  common.training_before = d.nominal;
  common.training_after = d.after;
  common.held_out_before = d.nominal;
  common.held_out_after = d.held_out;
  common.noise_floor = d.noise;
  common.noise_ratio = d.noise > 0 ? d.held_out / d.noise : std::nan("");
  for (std::size_t b = 0; b < held_out.after.size(); ++b) {
    const std::string name =
        evidence.recordings.size() == 1 ? "block " + std::to_string(b + 1) : evidence.recordings[b].name;
    common.per_recording.push_back({name, held_out.before[b], held_out.after[b], held_out.after[b], 0, false});
  }
  if (d.nominal > 0) {
    std::vector<double> ratio;
    double mean = 0, square = 0;
    for (std::size_t b = 0; b < held_out.after.size(); ++b)
      ratio.push_back(held_out.after[b] / std::max(1e-300, held_out.before[b]));
    for (const double r : ratio) mean += r / static_cast<double>(ratio.size());
    for (const double r : ratio) square += (r - mean) * (r - mean);
    const double error =
        std::sqrt(square / static_cast<double>(std::max<std::size_t>(1, ratio.size() * (ratio.size() - 1))));
    common.gain_low = mean - z95 * error;
    common.gain_high = mean + z95 * error;
  }
  for (std::size_t j = 0; j < joints; ++j) {
    if (evidence.silent[j] != 0)
      common.remarks.push_back({"", "the torque of " + d.joints[j].joint +
                                        " hardly ever changes: taken as not recorded, nothing is said of it"});
  }
  for (const std::string& dropped : found.dropped) common.remarks.push_back({"", dropped});
  name_effects(evidence, found, d);
  name_alternatives(evidence, found, d);
  name_invisible(evidence, found, d);
  compare_with_groups(evidence, found, d);
  share_errors(evidence, found, d);
  name_sign_faults(evidence, d);
  draw_worst(evidence, d);
  conclude(evidence, d);
  return d;
}

}  // namespace diagnose_robot
