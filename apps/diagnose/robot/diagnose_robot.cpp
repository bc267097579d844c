#include "diagnose_robot.hpp"

#include <algorithm>
#include <cmath>

#include "../wording.hpp"
#include "simulate_robot.hpp"
#include "surefoot/core/rng.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::percent;
using diagnose_program::rounded;
using surefoot::FittedValue;

constexpr double z95 = 1.96;  // of a normal distribution

bool is_torque_driven(const Evidence& evidence) { return evidence.robot.setup.drive == DriveKind::torque; }

// Errors of all joints in one number: root mean square angle, or share of the drives' torque.
double overall(const Evidence& evidence, const Eigen::VectorXd& rms) {
  double sum = 0, joints = 0;
  for (Eigen::Index j = 0; j < rms.size(); ++j) {
    if (evidence.silent[static_cast<std::size_t>(j)] != 0) continue;
    const double unit = is_torque_driven(evidence) ? evidence.scales[static_cast<std::size_t>(j)].reading : 1;
    sum += rms[j] * rms[j] / (unit * unit);
    joints += 1;
  }
  return std::sqrt(sum / std::max(1.0, joints));
}

RobotPhysics physics_at(const Evidence& evidence, const Eigen::VectorXd& theta) {
  return physics_of(evidence.terms, theta, evidence.robot.joints.size());
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
        return rms_by_joint(evidence, errors_of(evidence, physics_at(evidence, found.theta + fit.change)), static_cast<int>(b));
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

// Of the angles, or of the torques: their own noise, and what that of the angles makes of speeds and accelerations.
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
      const Eigen::MatrixXd change = torque_residual(evidence.robot, smooth(noisy), physics) - torque_residual(evidence.robot, evidence.motions[r], physics);
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

std::string sentence_of(const Evidence& evidence, const Term& term, double value, double error, bool known) {
  const PropertyInfo& info = info_of(term.property);
  const std::string unit = unit_of(evidence.robot, term), place = place_of(evidence.robot, term);
  const std::string size = rounded(value) + (unit == "1" ? "" : " " + unit) + " +- " + rounded(z95 * error, 2);
  if (term.group == single_joint && evidence.robot.groups[static_cast<std::size_t>(evidence.robot.joints[static_cast<std::size_t>(term.joints.front())].group)].size() > 1) {
    return place + " differs from its group: " + info.of_group + ", by " + size;
  }
  return std::string(info.of_group) + " of " + size + " at " + place + (known ? ", as the file has it" : "");
}

// Whether the size that the file has for this would do as well: the error of the joints rises by less than is negligible.
bool is_in_file(const Evidence& evidence, const SearchResult& found, Eigen::Index t) {
  constexpr double negligible = 0.02;  // of the error, as for terms that held-out blocks do not want
  const Term& term = evidence.terms[static_cast<std::size_t>(t)];
  double nominal = 0;
  for (const int j : term.joints) {
    nominal += evidence.robot.nominal[static_cast<std::size_t>(j)][term.property] / static_cast<double>(term.joints.size());
  }
  if (nominal == 0 || term.group == single_joint) return false;
  LinearModel as_in_file = found.linear;
  as_in_file.low[t] = as_in_file.high[t] = nominal;
  const Eigen::VectorXd with = fit_linear(found.linear, found.set).square, without = fit_linear(as_in_file, found.set).square;
  double before = 0, after = 0, numerical = 0;
  for (const int j : term.joints) {
    before += with[j];
    after += without[j];
    if (evidence.numerical.size() > 0) numerical += evidence.numerical[j] * evidence.numerical[j] * found.linear.whole[static_cast<std::size_t>(j)].rows;
  }
  constexpr double times_numerical = 2;
  return std::sqrt(after) < (1 + negligible) * std::sqrt(before) || after - before < times_numerical * times_numerical * numerical;
}

void name_effects(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  const Eigen::VectorXd error = standard_errors(found.linear, found.set), odds = evidence_of_terms(found.linear, found.set);
  const Eigen::VectorXd gain = held_out_gain(found.linear, found.set).share;
  for (std::size_t t = 0; t < found.set.size(); ++t) {
    if (found.set[t] == 0) continue;
    const auto at = static_cast<Eigen::Index>(t);
    const Term& term = evidence.terms[t];
    const PropertyInfo& info = info_of(term.property);
    if (found.theta[at] == 0) continue;  // what the file has and the robot has not; the table of the corrected model tells
    const bool known = is_in_file(evidence, found, at);
    FittedValue value{info.parameter, unit_of(evidence.robot, term), found.theta[at], found.theta[at] - z95 * error[at], found.theta[at] + z95 * error[at]};
    if (info.calibration) {
      value.name = std::string(info.parameter) + " at " + place_of(evidence.robot, term);
      d.common.augmented_parameters.push_back({value, 0, value.value <= term.low || value.value >= term.high, false});
    }
    surefoot::FoundEffect effect;
    effect.name = info.effect;
    effect.attached_to = place_of(evidence.robot, term);
    effect.sentence = sentence_of(evidence, term, found.theta[at], error[at], known);
    effect.parameters = {value};
    effect.parameters.front().name = info.parameter;
    effect.evidence.gain = gain[at];
    effect.evidence.confidence = 1 / (1 + std::exp(-odds[at] / 2));
    effect.evidence.p_value = std::exp(-odds[at] / 2);
    effect.form = term.group == single_joint ? "joint" : term.group == all_joints ? "all" : "group";
    (known ? d.common.known_effects : d.common.effects).push_back(effect);
  }
}

void name_alternatives(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  const TermSet all(evidence.terms.size(), 1);
  double others = 0;
  for (const TermAlternative& one : alternatives_of(found.linear, found.set, all)) {
    const Term& term = evidence.terms[static_cast<std::size_t>(one.other)];
    const Term& instead = evidence.terms[static_cast<std::size_t>(one.instead)];
    surefoot::Alternative alternative;
    alternative.effects = {{info_of(term.property).effect, place_of(evidence.robot, term)}};
    alternative.indistinguishable = true;
    alternative.fitted_rmse = d.after;
    alternative.probability = std::exp(-std::max(0.0, one.criterion) / 2);
    others += alternative.probability;
    d.common.alternatives.push_back(alternative);
    d.common.remarks.push_back({"", std::string(info_of(instead.property).effect) + " at " + place_of(evidence.robot, instead) +
                                        " cannot be told apart from " + info_of(term.property).effect + " at " + place_of(evidence.robot, term)});
  }
  d.common.probability = 1 / (1 + others);
  for (surefoot::Alternative& one : d.common.alternatives) one.probability /= 1 + others;
}

// Single joints against what their group has: named, or ruled out.
void compare_with_groups(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  for (std::size_t s = 0; s < evidence.terms.size(); ++s) {
    const Term& single = evidence.terms[s];
    if (single.group != single_joint) continue;
    for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
      const Term& tied = evidence.terms[t];
      if (tied.group < 0 || tied.property != single.property || tied.joints.size() < 2 || found.set[t] == 0) continue;
      if (std::ranges::find(tied.joints, single.joints.front()) == tied.joints.end()) continue;
      TermSet set = found.set;
      set[s] = 1;
      const auto at = static_cast<Eigen::Index>(s);
      const PropertyInfo& info = info_of(single.property);
      d.differences.push_back({place_of(evidence.robot, single), place_of(evidence.robot, tied), info.effect, info.parameter,
                               unit_of(evidence.robot, single), found.theta[at] + fit_linear(found.linear, set).change[at],
                               standard_errors(found.linear, set)[at], found.theta[static_cast<Eigen::Index>(t)], found.set[s] != 0});
    }
  }
}

// Share of each joint's error that goes with an effect, all of its places together.
void share_errors(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  for (std::size_t t = 0; t < found.set.size(); ++t) {
    const std::string name = info_of(evidence.terms[t].property).effect;
    if (found.set[t] != 0 && std::ranges::find(d.effect_columns, name) == d.effect_columns.end()) d.effect_columns.push_back(name);
  }
  const Eigen::VectorXd with = fit_linear(found.linear, found.set).square;
  d.shares.resize(with.size(), static_cast<Eigen::Index>(d.effect_columns.size()));
  for (std::size_t c = 0; c < d.effect_columns.size(); ++c) {
    TermSet set = found.set;
    for (std::size_t t = 0; t < set.size(); ++t) {
      if (info_of(evidence.terms[t].property).effect == d.effect_columns[c]) set[t] = 0;
    }
    const Eigen::VectorXd without = fit_linear(found.linear, set).square;
    d.shares.col(static_cast<Eigen::Index>(c)) = (1 - (with.array() / without.array().max(1e-300)).sqrt()).max(0);
  }
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
    const Eigen::MatrixXd rigid = torque_residual(evidence.robot, motion, RobotPhysics(physics.size()));
    const Eigen::MatrixXd after = torque_residual(evidence.robot, motion, physics);
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

void draw_worst(const Evidence& evidence, RobotDiagnosis& d) {
  constexpr std::size_t most = 4;  // joints that are drawn
  std::vector<std::size_t> by_error(d.joints.size());
  for (std::size_t j = 0; j < by_error.size(); ++j) by_error[j] = j;
  std::ranges::sort(by_error, [&](std::size_t a, std::size_t b) {
    const auto size = [&](std::size_t j) { return d.torque_driven ? d.joints[j].after / std::max(1e-9, d.joints[j].torque) : d.joints[j].after; };
    return size(a) > size(b);
  });
  by_error.resize(std::min(most, by_error.size()));
  for (const std::size_t j : by_error) d.torques.push_back(torque_picture(evidence, static_cast<Eigen::Index>(j), d.physics));
  const RobotRecording& recording = evidence.recordings.front();
  const Motion& motion = evidence.motions.front();
  const Eigen::MatrixXd nominal = d.torque_driven ? torque_residual(evidence.robot, motion, RobotPhysics(d.physics.size()))
                                                  : simulate_robot(evidence.robot, recording, start_of(motion), evidence.robot.nominal);
  const Eigen::MatrixXd after = d.torque_driven ? torque_residual(evidence.robot, motion, d.physics)
                                                : simulate_robot(evidence.robot, recording, start_of(motion), d.physics);
  for (const std::size_t j : by_error) {
    const auto c = static_cast<Eigen::Index>(j);
    d.curves.push_back({d.joints[j].joint, recording.time, d.torque_driven ? Eigen::VectorXd() : Eigen::VectorXd(recording.angle.col(c)),
                        nominal.col(c), after.col(c)});
  }
}

// Recorded torques of the other sign are a fault of the log.
void name_sign_faults(const Evidence& evidence, RobotDiagnosis& d) {
  for (std::size_t j = 0; j < d.physics.size(); ++j) {
    if (!(d.physics[j][Property::reading_scale] < -1)) continue;
    const JointSetup& joint = evidence.robot.joints[j].setup;
    surefoot::LogFault fault;
    fault.kind = "sign_flipped";
    fault.channel = joint.torque.name;
    fault.size = 1 + d.physics[j][Property::reading_scale];
    fault.unit = "1";
    fault.sentence = joint.torque.name + " has the other sign than the motion of " + joint.name;
    fault.cure = "write torque = { column = \"" + joint.torque.name + "\", factor = -1 } in the setup";
    d.common.log_faults.push_back(fault);
  }
}

void conclude(const Evidence& evidence, RobotDiagnosis& d) {
  std::size_t calibrated = 0;
  for (const auto& effect : d.common.effects) {
    for (const PropertyInfo& info : property_table()) calibrated += effect.name == info.effect && info.calibration && effect.parameters.front().name == info.parameter ? 1 : 0;
  }
  const std::size_t effects = d.common.effects.size() - calibrated;
  d.common.verdict = verdict_of(effects, calibrated, d.held_out, d.noise, d.common.complete);
  std::string sentence;
  for (const auto& effect : d.common.effects) sentence += (sentence.empty() ? "" : "; ") + effect.sentence;
  const std::string unit = d.torque_driven ? " of the drives' torque" : " rad";
  const std::string figures = "the error on held-out " + std::string(d.common.held_out == d.common.fit && evidence.recordings.size() == 1 ? "blocks" : "recordings") + " is " +
                              rounded(d.held_out) + unit + " instead of " + rounded(d.common.held_out_before) + " of the file as it stands";
  d.common.sentence = (sentence.empty() ? "nothing is missing that these recordings show" : sentence) + "; " + figures;
}

}  // namespace

double noise_of(const Eigen::Ref<const Eigen::VectorXd>& readings) {
  constexpr double gain = 70;        // sum of squares of 1, -4, 6, -4, 1
  constexpr double of_median = 0.6745;  // median of |x| of a normal distribution
  std::vector<double> differences;
  double square = 0;
  for (Eigen::Index k = 4; k < readings.size(); ++k) {
    const double d = readings[k] - 4 * readings[k - 1] + 6 * readings[k - 2] - 4 * readings[k - 3] + readings[k - 4];
    differences.push_back(std::abs(d));
    square += d * d;
  }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::ranges::nth_element(differences, middle);
  const double robust = *middle / of_median;
  const double plain = std::sqrt(square / static_cast<double>(differences.size()));
  return (robust > 0 ? robust : plain) / std::sqrt(gain);  // readings that mostly stay the same have a median of 0
}

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
  const Eigen::VectorXd nominal = rms_by_joint(evidence, errors_of(evidence, evidence.robot.nominal));
  d.textbook = d.nominal = d.after = d.held_out = overall(evidence, nominal);
  d.noise = d.replayed = std::nan("");
  d.common.model = evidence.robot.model.file;
  d.common.verdict = surefoot::Verdict::unexplained;
  d.common.held_out_before = d.common.held_out_after = d.nominal;
  for (const surefoot::LogFault& fault : faults) d.common.sentence += (d.common.sentence.empty() ? "" : "; ") + fault.sentence + "; " + fault.cure + ", or run again with --repair";
  return d;
}

void hold_out(const Evidence& test, RobotDiagnosis& d) {
  const Eigen::MatrixXd nominal = errors_of(test, test.robot.nominal), after = errors_of(test, d.physics);
  const Eigen::VectorXd by_joint = rms_by_joint(test, after);
  d.held_out = overall(test, by_joint);
  d.common.held_out.clear();
  d.common.per_recording.clear();
  for (const RobotRecording& recording : test.recordings) d.common.held_out.push_back(recording.name);
  for (int b = 0; b < test.blocks; ++b) {
    const std::string name = test.recordings.size() == 1 ? "block " + std::to_string(b + 1) : test.recordings[static_cast<std::size_t>(b)].name;
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
  const Eigen::MatrixXd textbook = errors_of(evidence, RobotPhysics(joints)), nominal = errors_of(evidence, evidence.robot.nominal);
  const Eigen::VectorXd by_textbook = rms_by_joint(evidence, textbook), by_nominal = rms_by_joint(evidence, nominal),
                        by_after = rms_by_joint(evidence, found.errors);
  const HeldOut held_out = held_out_errors(evidence, found, nominal);
  Eigen::VectorXd noise = noise_by_joint(evidence, d.physics, 1);
  if (evidence.numerical.size() > 0) noise = (noise.cwiseAbs2() + evidence.numerical.cwiseAbs2()).cwiseSqrt();  // no simulation is nearer
  d.textbook = overall(evidence, by_textbook);
  d.nominal = overall(evidence, by_nominal);
  d.after = overall(evidence, by_after);
  d.held_out = overall(evidence, held_out.by_joint);
  d.noise = overall(evidence, noise);
  for (std::size_t j = 0; j < joints; ++j) {
    const RobotJoint& joint = evidence.robot.joints[j];
    const auto c = static_cast<Eigen::Index>(j);
    const std::string unit = d.torque_driven ? (joint.model.slides ? "N" : "N m") : joint.model.slides ? "m" : "rad";
    d.joints.push_back({joint.setup.name, evidence.robot.setup.groups[static_cast<std::size_t>(joint.group)].name, unit, by_textbook[c],
                        by_nominal[c], by_after[c], held_out.by_joint[c], noise[c], evidence.scales[j].reading});
    d.common.channels.push_back({joint.setup.angle.name, unit, by_textbook[c], by_nominal[c], by_after[c], noise[c], 0});
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
    const std::string name = evidence.recordings.size() == 1 ? "block " + std::to_string(b + 1) : evidence.recordings[b].name;
    common.per_recording.push_back({name, held_out.before[b], held_out.after[b], held_out.after[b], 0, false});
  }
  if (d.nominal > 0) {
    std::vector<double> ratio;
    double mean = 0, square = 0;
    for (std::size_t b = 0; b < held_out.after.size(); ++b) ratio.push_back(held_out.after[b] / std::max(1e-300, held_out.before[b]));
    for (const double r : ratio) mean += r / static_cast<double>(ratio.size());
    for (const double r : ratio) square += (r - mean) * (r - mean);
    const double error = std::sqrt(square / static_cast<double>(std::max<std::size_t>(1, ratio.size() * (ratio.size() - 1))));
    common.gain_low = mean - z95 * error;
    common.gain_high = mean + z95 * error;
  }
  for (std::size_t j = 0; j < joints; ++j) {
    if (evidence.silent[j] != 0) common.remarks.push_back({"", "the torque of " + d.joints[j].joint + " hardly ever changes: taken as not recorded, nothing is said of it"});
  }
  for (const std::string& dropped : found.dropped) common.remarks.push_back({"", dropped});
  name_effects(evidence, found, d);
  name_alternatives(evidence, found, d);
  compare_with_groups(evidence, found, d);
  share_errors(evidence, found, d);
  name_sign_faults(evidence, d);
  draw_worst(evidence, d);
  conclude(evidence, d);
  return d;
}

}  // namespace diagnose_robot
