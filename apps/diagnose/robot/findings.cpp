#include "findings.hpp"

#include <algorithm>
#include <cmath>

#include "../wording.hpp"
#include "uncertain_bodies.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::rounded;
using surefoot::FittedValue;

std::string sentence_of(const Evidence& evidence, const Term& term, double value, double error) {
  const PropertyInfo& info = info_of(term.property);
  const std::string unit = unit_of(evidence.robot, term), place = place_of(evidence.robot, term);
  const std::string size = rounded(value) + (unit == "1" ? "" : " " + unit) + " +- " + rounded(z95 * error, 2);
  if (term.group == single_joint &&
      evidence.robot
              .groups[static_cast<std::size_t>(
                  evidence.robot.joints[static_cast<std::size_t>(term.joints.front())].group)]
              .size() > 1) {
    return place + " differs from its group: " + info.of_group + ", by " + size;
  }
  return std::string(info.of_group) + " of " + size + " at " + place;
}

std::string timing_sentence(Property property, double seconds) {
  const std::string size = rounded(1000 * std::abs(seconds)) + " ms";
  const std::string what = property == Property::reading_age ? "the drives act on readings that are " + size + " old"
                           : property == Property::speed_age
                               ? "the drives act on speeds that are " + size + " older than their angles"
                               : "goals act " + size + (seconds < 0 ? " earlier" : " later") + " than they are logged";
  return what + ", a part of a row or of the drives' period: no missing physics";
}

// A stated tie: the inertia of a rotor, and that of the link which turns with it.
void name_links(const Evidence& evidence, const std::vector<Eigen::Index>& like_link, RobotDiagnosis& d) {
  for (const Eigen::Index t : like_link) {
    const Term& term = evidence.terms[static_cast<std::size_t>(t)];
    const std::string place = place_of(evidence.robot, term);
    surefoot::Alternative alternative;
    alternative.effects = {{info_of(Property::link_inertia).effect, place}};
    alternative.indistinguishable = true;
    alternative.fitted_rmse = d.after;
    alternative.probability = 1;
    d.common.alternatives.push_back(alternative);
    d.common.remarks.push_back({"", "rotor_inertia at " + place +
                                        " cannot be told apart from as much more inertia of the links that turn with "
                                        "it than the model states; only their sum is measured"});
  }
}

// Friction and rotor inertia of groups, or of joints alone in theirs, that are not there.
std::vector<Eigen::Index> friction_not_there(const Evidence& evidence, const TermSet& set) {
  std::vector<Eigen::Index> result;
  for (std::size_t t = 0; t < set.size(); ++t) {
    const Term& term = evidence.terms[t];
    const bool asked =
        term.property == Property::coulomb || term.property == Property::viscous || term.property == Property::armature;
    const auto silent = [&](int j) { return evidence.silent[static_cast<std::size_t>(j)] != 0; };
    if (asked && set[t] == 0 && term.group >= 0 && std::ranges::none_of(term.joints, silent))
      result.push_back(static_cast<Eigen::Index>(t));
  }
  return result;
}

void list_not_named(const Evidence& evidence, const SearchResult& found, const std::vector<Eigen::Index>& others,
                    const Eigen::VectorXd& error, RobotDiagnosis& d) {
  for (const Eigen::Index t : others) {
    const Term& term = evidence.terms[static_cast<std::size_t>(t)];
    const PropertyInfo& info = info_of(term.property);
    TermSet set = found.set;
    set[static_cast<std::size_t>(t)] = 1;
    const double value = nominal_of(evidence.robot, term) + fit_linear(found.linear, set).change[t];
    d.not_named.push_back(
        {place_of(evidence.robot, term), info.effect, info.parameter, unit_of(evidence.robot, term), value, error[t]});
  }
}

// Where every other joint of the group has a difference of its own, what the group has is what this joint has.
bool stands_for_group(const Evidence& evidence, const TermSet& set, const Term& single, const Term& tied) {
  return std::ranges::all_of(tied.joints, [&](int joint) {
    if (joint == single.joints.front()) return true;
    for (std::size_t t = 0; t < set.size(); ++t) {
      const Term& term = evidence.terms[t];
      if (set[t] != 0 && term.group == single_joint && term.property == single.property && term.joints.front() == joint)
        return true;
    }
    return false;
  });
}

}  // namespace

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

void name_effects(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  const std::vector<Eigen::Index> others = friction_not_there(evidence, found.set);
  const UncertainBodies bodies = allow_for_bodies(evidence, found, others);
  const Eigen::VectorXd& error = bodies.standard_errors;
  list_not_named(evidence, found, others, error, d);
  const Eigen::VectorXd odds = evidence_of_terms(found.linear, found.set);
  name_links(evidence, bodies.like_link, d);
  for (std::size_t t = 0; t < found.set.size(); ++t) {
    if (found.set[t] == 0) continue;
    const auto at = static_cast<Eigen::Index>(t);
    const Term& term = evidence.terms[t];
    const PropertyInfo& info = info_of(term.property);
    if (is_of_timing(term.property)) {
      d.common.remarks.push_back({"", timing_sentence(term.property, found.theta[at])});
      continue;
    }
    const double value_now = found.theta[at] + (term.group == single_joint ? 0 : nominal_of(evidence.robot, term));
    FittedValue value{info.parameter, unit_of(evidence.robot, term), value_now, value_now - z95 * error[at],
                      value_now + z95 * error[at]};
    if (info.calibration) {
      value.name = std::string(info.parameter) + " at " + place_of(evidence.robot, term);
      d.common.augmented_parameters.push_back(
          {value, 0, found.theta[at] <= term.low || found.theta[at] >= term.high, false});
    }
    if (std::abs(found.theta[at]) < z95 * error[at])  // only as bodies are uncertain: see drop_one()
      d.common.remarks.push_back(
          {"", std::string(info.effect) + " at " + place_of(evidence.robot, term) +
                   " may as well be masses, centres of mass and inertias of links that are off by some 10 %; with "
                   "\"bodies\" under calibrate they are told apart where recordings can"});
    surefoot::FoundEffect effect;
    effect.name = info.effect;
    effect.attached_to = place_of(evidence.robot, term);
    effect.sentence = sentence_of(evidence, term, value_now, error[at]);
    effect.parameters = {value};
    effect.parameters.front().name = info.parameter;
    effect.evidence.gain = held_out_gain(found.linear, found.set, at).share;
    effect.evidence.confidence = 1 / (1 + std::exp(-odds[at] / 2));
    effect.evidence.p_value = std::exp(-odds[at] / 2);
    effect.form = term.group == single_joint ? "joint" : term.group == all_joints ? "all" : "group";
    d.common.effects.push_back(effect);
  }
}

void name_alternatives(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  const TermSet all(evidence.terms.size(), 1);
  double others = 0;
  for (const surefoot::Alternative& one : d.common.alternatives) others += one.probability;
  for (const TermAlternative& one : alternatives_of(found.linear, found.set, all)) {
    const Term& term = evidence.terms[static_cast<std::size_t>(one.other)];
    const Term& instead = evidence.terms[static_cast<std::size_t>(one.instead)];
    if (is_of_timing(instead.property)) continue;  // is not named itself
    if (!explain_the_same(found.linear, found.set, one)) continue;
    surefoot::Alternative alternative;
    alternative.effects = {{info_of(term.property).effect, place_of(evidence.robot, term)}};
    alternative.indistinguishable = true;
    alternative.fitted_rmse = d.after;
    alternative.probability = std::exp(-std::max(0.0, one.criterion) / 2);
    others += alternative.probability;
    d.common.alternatives.push_back(alternative);
    d.common.remarks.push_back({"", std::string(info_of(instead.property).effect) + " at " +
                                        place_of(evidence.robot, instead) + " cannot be told apart from " +
                                        info_of(term.property).effect + " at " + place_of(evidence.robot, term)});
  }
  d.common.probability = 1 / (1 + others);
  for (surefoot::Alternative& one : d.common.alternatives) one.probability /= 1 + others;
}

void compare_with_groups(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  for (std::size_t s = 0; s < evidence.terms.size(); ++s) {
    const Term& single = evidence.terms[s];
    if (single.group != single_joint) continue;
    for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
      const Term& tied = evidence.terms[t];
      if (tied.group < 0 || tied.property != single.property || tied.joints.size() < 2 || found.set[t] == 0) continue;
      if (std::ranges::find(tied.joints, single.joints.front()) == tied.joints.end()) continue;
      if (stands_for_group(evidence, found.set, single, tied)) continue;
      TermSet set = found.set;
      set[s] = 1;
      const auto at = static_cast<Eigen::Index>(s);
      const PropertyInfo& info = info_of(single.property);
      d.differences.push_back(
          {place_of(evidence.robot, single), place_of(evidence.robot, tied), info.effect, info.parameter,
           unit_of(evidence.robot, single), found.theta[at] + fit_linear(found.linear, set).change[at],
           standard_errors(found.linear, set)[at], found.theta[static_cast<Eigen::Index>(t)], found.set[s] != 0});
    }
  }
}

void share_errors(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  for (std::size_t t = 0; t < found.set.size(); ++t) {
    const std::string name = info_of(evidence.terms[t].property).effect;
    if (is_of_timing(evidence.terms[t].property)) continue;
    if (found.set[t] != 0 && std::ranges::find(d.effect_columns, name) == d.effect_columns.end())
      d.effect_columns.push_back(name);
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
    for (const PropertyInfo& info : property_table())
      calibrated +=
          effect.name == info.effect && info.calibration && effect.parameters.front().name == info.parameter ? 1 : 0;
  }
  const std::size_t effects = d.common.effects.size() - calibrated;
  d.common.verdict = verdict_of(effects, calibrated, d.held_out, d.noise, d.common.complete);
  std::string sentence;
  for (const auto& effect : d.common.effects) sentence += (sentence.empty() ? "" : "; ") + effect.sentence;
  const std::string unit = d.torque_driven ? " of the drives' torque" : " rad";
  const std::string figures =
      "the error on held-out " +
      std::string(d.common.held_out == d.common.fit && evidence.recordings.size() == 1 ? "blocks" : "recordings") +
      " is " + rounded(d.held_out) + unit + " instead of " + rounded(d.common.held_out_before) +
      " of the file as it stands";
  d.common.sentence = (sentence.empty() ? "nothing is missing that these recordings show" : sentence) + "; " + figures;
}

}  // namespace diagnose_robot
