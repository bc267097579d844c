#include "term_priors.hpp"

#include <algorithm>
#include <cmath>

namespace diagnose_robot {
namespace {

constexpr double prior_share = 0.5;  // of the bounds of a property of drives and joints: hardly a prior
// Of a typical size: 1 % of the torque of a drive, of a gain or a mass. No drive repeats better, and two simulations of
// one model differ by such amounts.
constexpr double smallest_share = 0.1;
// Joints of one kind differ by as much in friction, by wear and lubrication: such a difference makes none the odd one.
constexpr double ordinary_spread = 0.25;
constexpr double stated_prior = 2;  // typical sizes: a gain or mass that is stated is rarely off by more than some 20 %

double smallest_size(const Evidence& evidence, const Term& term, double of_group) {
  double smallest = smallest_share * term.typical;
  if (term.group == single_joint) smallest = std::max(smallest, ordinary_spread * std::abs(of_group));
  if (term.property == Property::delay || term.property == Property::lag)
    smallest = std::max(smallest, row_share * evidence.recordings.front().row_period());
  return smallest;
}

// Terms that make a term of this kind possible at all of its joints: more friction at rest than in motion needs some in
// motion, drag by the square of speed some by speed itself.
std::vector<Eigen::Index> bases_of(const Evidence& evidence, const Term& term) {
  std::vector<Eigen::Index> bases;
  if (term.property != Property::breakaway && term.property != Property::drag) return bases;
  const Property base = term.property == Property::breakaway ? Property::coulomb : Property::viscous;
  for (const int j : term.joints) {
    if (evidence.robot.nominal[static_cast<std::size_t>(j)][base] > 0) return bases;  // the file has it
  }
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    const Term& other = evidence.terms[t];
    const bool covers = std::ranges::all_of(
        term.joints, [&](int j) { return std::ranges::find(other.joints, j) != other.joints.end(); });
    if (other.property == base && covers) bases.push_back(static_cast<Eigen::Index>(t));
  }
  return bases;
}

// What the group of a single joint has of this property, with what the file states.
double of_group(const Evidence& evidence, const LinearModel& model, const Term& single) {
  double sum = nominal_of(evidence.robot, single);
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    const Term& tied = evidence.terms[t];
    if (tied.property != single.property || tied.group == single_joint) continue;
    if (std::ranges::find(tied.joints, single.joints.front()) != tied.joints.end())
      sum += model.theta[static_cast<Eigen::Index>(t)];
  }
  return sum;
}

// Joints whose errors a term is there for: bodies and offsets of encoders load all joints of their tree.
std::vector<int> joints_of_effect(const Evidence& evidence, const Term& term) {
  if (!is_of_body(term.property) && term.property != Property::sensor_bias) return term.joints;
  std::vector<int> joints;
  for (std::size_t j = 0; j < evidence.robot.joints.size(); ++j) {
    if (moves(evidence, term, j)) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

}  // namespace

bool moves(const Evidence& evidence, const Term& term, std::size_t joint) {
  const int tree = evidence.robot.joints[joint].tree;
  return std::ranges::any_of(term.joints,
                             [&](int j) { return evidence.robot.joints[static_cast<std::size_t>(j)].tree == tree; });
}

void set_priors(const Evidence& evidence, LinearModel& model) {
  const auto count = static_cast<Eigen::Index>(evidence.terms.size());
  model.acts_on.clear();
  model.refines.clear();
  model.of_groups.assign(evidence.terms.size(), 0);
  for (Eigen::VectorXd* vector :
       {&model.low, &model.high, &model.prior, &model.smallest, &model.cost, &model.least_taken})
    vector->resize(count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const Term& term = evidence.terms[static_cast<std::size_t>(t)];
    const PropertyInfo& info = info_of(term.property);
    const bool stated = info.calibration || term.property == Property::torque_gain;
    model.of_groups[static_cast<std::size_t>(t)] = term.group == single_joint ? 0 : 1;
    model.low[t] = term.low;
    const double tied = term.group == single_joint ? of_group(evidence, model, term) : nominal_of(evidence.robot, term);
    if (info.low >= 0) model.low[t] = -tied;  // with what the file and its group have not below 0
    model.high[t] = term.high;
    model.prior[t] = stated ? stated_prior * term.typical : prior_share * std::max(term.high, -term.low);
    model.smallest[t] = smallest_size(evidence, term, tied);
    model.acts_on.push_back(joints_of_effect(evidence, term));
    double independent = 0, alike = 0;
    for (const int j : model.acts_on.back()) independent += model.independent[j];
    for (const Term& other : evidence.terms)
      alike += (other.group == single_joint) == (term.group == single_joint) ? 1 : 0;
    // Schwarz's log n for the parameter, and the choice among so many terms (extended BIC of Chen and Chen, 2008),
    // which is none where every drive has it.
    model.cost[t] = std::log(independent) + (is_of_timing(term.property) ? 0 : 2 * std::log(alike));
    double numerical = 0;
    for (const int j : model.acts_on.back()) {
      if (evidence.numerical.size() > 0)
        numerical += evidence.numerical[j] * evidence.numerical[j] / static_cast<double>(model.acts_on.back().size());
    }
    // What is never named must not be large enough for a name: or something else would stand for it.
    model.least_taken[t] = is_of_timing(term.property) ? 0 : times_numerical * std::sqrt(numerical);
    model.refines.push_back(bases_of(evidence, term));
  }
}

}  // namespace diagnose_robot
