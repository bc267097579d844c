#include "search_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "starts.hpp"

namespace diagnose_robot {

Eigen::MatrixXd errors_at(const Evidence& evidence, const Eigen::VectorXd& theta,
                          const std::vector<StartState>& starts) {
  return errors_of(evidence, physics_of(evidence.terms, theta, evidence.base), starts);
}

double misfit(const Evidence& evidence, const LinearModel& model, const Point& point) {
  const Eigen::VectorXd rms = rms_by_joint(evidence, point.errors);
  Eigen::VectorXd square = Eigen::VectorXd::Zero(rms.size()), count = square;
  for (Eigen::Index j = 0; j < rms.size(); ++j) {
    const int pool = model.pool[static_cast<std::size_t>(j)];
    square[pool] += model.independent[j] * rms[j] * rms[j];
    count[pool] += model.independent[j];
  }
  double sum = 0;
  for (Eigen::Index p = 0; p < rms.size(); ++p) {
    if (count[p] > 0) sum += count[p] * std::log(std::max(1e-24, square[p] / count[p]));
  }
  if (evidence.robot.setup.drive != DriveKind::torque) sum += start_cost(evidence, point.starts);
  for (Eigen::Index t = 0; t < point.theta.size(); ++t) {
    sum += prior_cost(model, t, point.theta[t]);
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

double cost_of(const LinearModel& model, const TermSet& set) {
  double sum = 0;
  for (std::size_t t = 0; t < set.size(); ++t) sum += set[t] != 0 ? model.cost[static_cast<Eigen::Index>(t)] : 0;
  return sum;
}

double misfit_and_cost(const Evidence& evidence, const LinearModel& model, const Point& point) {
  return misfit(evidence, model, point) + cost_of(model, point.set);
}

bool move(const Evidence& evidence, const LinearModel& model, const TermSet& set, const MoveCriteria& criteria,
          Point& point) {
  const Eigen::VectorXd change = fit_linear(model, set).change;
  // Errors may rise by what terms that are taken away cost.
  const double saved = std::max(0.0, cost_of(model, point.set) - cost_of(model, set));
  const double limit = misfit(evidence, model, point) + (set == point.set ? -criteria.settled : saved);
  double share = 1;
  for (int halving = 0; halving <= criteria.most_halvings; ++halving, share /= 2) {
    Point next{point.theta, set, moved_starts(model, point.starts, change, share), {}};
    for (Eigen::Index t = 0; t < change.size(); ++t) {
      next.theta[t] = set[static_cast<std::size_t>(t)] != 0 ? point.theta[t] + share * change[t] : 0;
    }
    next.errors = errors_at(evidence, next.theta, next.starts);
    if (misfit(evidence, model, next) < limit) {
      point = std::move(next);
      return true;
    }
  }
  return false;
}

void settle(const Evidence& evidence, const LinearModel& model, int most_moves, Point& point) {
  Evidence own = evidence;
  own.terms.clear();
  Point part{Eigen::VectorXd(std::ranges::count(point.set, 1)), {}, point.starts, point.errors};
  for (std::size_t t = 0; t < point.set.size(); ++t) {
    if (point.set[t] == 0) continue;
    part.theta[static_cast<Eigen::Index>(own.terms.size())] = point.theta[static_cast<Eigen::Index>(t)];
    own.terms.push_back(evidence.terms[t]);
  }
  own.entries = entries_of(own.terms);
  part.set.assign(own.terms.size(), 1);
  RigidCache cache;
  for (int k = 0; k < most_moves; ++k) {
    LinearModel here = linearize(own, part.theta, part.starts, part.errors, cache);
    here.independent = model.independent;
    if (!move(own, here, part.set, {}, part)) break;
  }
  Eigen::Index at = 0;
  for (std::size_t t = 0; t < point.set.size(); ++t) {
    if (point.set[t] != 0) point.theta[static_cast<Eigen::Index>(t)] = part.theta[at++];
  }
  point.starts = part.starts;
  point.errors = part.errors;
}

}  // namespace diagnose_robot
