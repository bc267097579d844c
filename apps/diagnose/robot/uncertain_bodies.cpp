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
      Term term;
      term.property = info.property;
      term.joints = {static_cast<int>(j)};
      term.typical = typical_size(info.property, evidence.scales[j]);
      term.low = info.low * term.typical;
      term.high = info.high * term.typical;
      wide.terms.push_back(term);
    }
  }
  wide.entries = entries_of(wide.terms);
  return wide;
}

}  // namespace

Eigen::VectorXd standard_errors_with_bodies(const Evidence& evidence, const SearchResult& found) {
  if (evidence.robot.setup.calibrate_bodies || !found.complete) return standard_errors(found.linear, found.set);
  const Evidence wide = with_bodies(evidence);
  const auto count = static_cast<Eigen::Index>(evidence.terms.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wide.terms.size()));
  theta.head(count) = found.theta;
  TermSet set(wide.terms.size(), 1);
  std::copy(found.set.begin(), found.set.end(), set.begin());
  RigidCache cache;
  return standard_errors(linearize(wide, theta, found.errors, cache), set).head(count);
}

}  // namespace diagnose_robot
