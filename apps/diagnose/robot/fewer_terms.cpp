#include "fewer_terms.hpp"

#include <algorithm>
#include <utility>

namespace diagnose_robot {
namespace {

bool acts_on(const Term& term, int joint) { return std::ranges::find(term.joints, joint) != term.joints.end(); }

// Terms of the set, but for those that are never named, which act on a joint of this one.
bool shares_joint(const Evidence& evidence, const TermSet& set, std::size_t term) {
  for (std::size_t other = 0; other < set.size(); ++other) {
    if (other == term || set[other] == 0 || is_of_timing(evidence.terms[other].property)) continue;
    for (const int joint : evidence.terms[term].joints) {
      if (acts_on(evidence.terms[other], joint)) return true;
    }
  }
  return false;
}

}  // namespace

bool do_with_fewer(const Evidence& evidence, const LinearModel& model, Point& point, const FewerCriteria& criteria) {
  double least = misfit_and_cost(evidence, model, point);
  bool found = false;
  Point best;
  for (std::size_t t = 0; t < point.set.size(); ++t) {
    const bool timing = is_of_timing(evidence.terms[t].property);
    if (point.set[t] == 0 || timing || !shares_joint(evidence, point.set, t)) continue;
    if (evidence.stop.stop_requested()) break;
    Point without = point;
    without.set[t] = 0;
    without.theta[static_cast<Eigen::Index>(t)] = 0;
    without.errors = errors_at(evidence, without.theta, without.starts);
    settle(evidence, model, criteria.fits, without);
    const double here = misfit_and_cost(evidence, model, without);
    if (here > least) continue;
    least = here;
    best = std::move(without);
    found = true;
  }
  if (found) point = std::move(best);
  return found;
}

}  // namespace diagnose_robot
