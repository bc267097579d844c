#include "uncertain_bodies.hpp"

#include <algorithm>

namespace diagnose_robot {
namespace {

// The same with terms for each link.
Evidence with_bodies(const Evidence& evidence) {
  Evidence wide(evidence.robot);
  wide.recordings = evidence.recordings;
  wide.motions = evidence.motions;
  wide.block = evidence.block;
  wide.blocks = evidence.blocks;
  wide.silent = evidence.silent;
  wide.scales = evidence.scales;
  wide.terms = evidence.terms;
  wide.threads = evidence.threads;
  wide.stop = evidence.stop;
  for (const PropertyInfo& info : property_table()) {
    if (!is_of_body(info.property) || info.property == Property::payload) continue;
    for (std::size_t j = 0; j < evidence.robot.joints.size(); ++j) {
      wide.terms.push_back(term_of_joint(info, j, evidence.scales[j]));
    }
  }
  wide.entries = entries_of(wide.terms);
  return wide;
}

// Square of the cosine between what two terms do to the errors of all joints, each in units of its own size.
double likeness(const LinearModel& model, Eigen::Index a, Eigen::Index b) {
  double across = 0, first = 0, second = 0;
  for (const Sums& sums : model.whole) {
    const double weight = sums.square > 0 ? sums.rows / sums.square : 0;
    across += weight * sums.gram(a, b);
    first += weight * sums.gram(a, a);
    second += weight * sums.gram(b, b);
  }
  return first > 0 && second > 0 ? across * across / (first * second) : 0;
}

// Terms of rotor inertia that the inertia of a link of theirs does as well.
std::vector<Eigen::Index> terms_like_links(const Evidence& wide, const LinearModel& model, const TermSet& set) {
  constexpr double alike = 0.98;  // of the square: what differs is less than noise shows
  std::vector<Eigen::Index> result;
  for (std::size_t t = 0; t < wide.terms.size(); ++t) {
    if (set[t] == 0 || wide.terms[t].property != Property::armature) continue;
    const auto is_like = [&](std::size_t u) {
      const Term& link = wide.terms[u];
      const bool own = link.property == Property::link_inertia &&
                       std::ranges::find(wide.terms[t].joints, link.joints.front()) != wide.terms[t].joints.end();
      return own && likeness(model, static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(u)) > alike;
    };
    for (std::size_t u = 0; u < wide.terms.size(); ++u) {
      if (!is_like(u)) continue;
      result.push_back(static_cast<Eigen::Index>(t));
      break;
    }
  }
  return result;
}

Eigen::VectorXd errors_with(const LinearModel& model, const TermSet& set, const std::vector<Eigen::Index>& others) {
  Eigen::VectorXd result = standard_errors(model, set);
  for (const Eigen::Index other : others) {
    TermSet more = set;
    more[static_cast<std::size_t>(other)] = 1;
    result[other] = standard_errors(model, more)[other];
  }
  return result;
}

}  // namespace

UncertainBodies allow_for_bodies(const Evidence& evidence, const SearchResult& found,
                                 const std::vector<Eigen::Index>& others) {
  if (evidence.robot.setup.calibrate_bodies || !found.complete)
    return {errors_with(found.linear, found.set, others), {}};
  const Evidence wide = with_bodies(evidence);
  const auto count = static_cast<Eigen::Index>(evidence.terms.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wide.terms.size()));
  theta.head(count) = found.theta;
  TermSet set(wide.terms.size(), 1);
  std::copy(found.set.begin(), found.set.end(), set.begin());
  RigidCache cache;
  const LinearModel model = linearize(wide, theta, found.starts, found.errors, cache);
  return {errors_with(model, set, others).head(count), terms_like_links(wide, model, set)};
}

}  // namespace diagnose_robot
