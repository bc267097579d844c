#include "search_terms.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "../wording.hpp"

namespace diagnose_robot {
namespace {

struct Point {
  Eigen::VectorXd theta;
  TermSet set;
  Eigen::MatrixXd errors;
};

Eigen::MatrixXd errors_at(const Evidence& evidence, const Eigen::VectorXd& theta) {
  return errors_of(evidence, physics_of(evidence.terms, theta, evidence.robot.nominal));
}

// What steps must lower: as the criterion of the linear model, without the cost of the terms.
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
  for (Eigen::Index t = 0; t < point.theta.size(); ++t) {
    const double share = point.theta[t] / model.prior[t];
    sum += share * share + (point.set[static_cast<std::size_t>(t)] != 0 ? model.cost[t] : 0);
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

TermSet either(TermSet a, const TermSet& b) {
  for (std::size_t t = 0; t < a.size(); ++t) a[t] = a[t] != 0 || b[t] != 0 ? 1 : 0;
  return a;
}

// Along the change, as far as errors fall. False if they do not.
bool move(const Evidence& evidence, const LinearModel& model, const TermSet& set, const SearchCriteria& criteria,
          Point& point) {
  const Eigen::VectorXd change = fit_linear(model, set).change;
  const double before = misfit(evidence, model, point);
  double share = 1;
  for (int halving = 0; halving <= criteria.most_halvings; ++halving, share /= 2) {
    Point next{point.theta, set, {}};
    for (Eigen::Index t = 0; t < change.size(); ++t) {
      next.theta[t] = set[static_cast<std::size_t>(t)] != 0 ? point.theta[t] + share * change[t] : 0;
    }
    next.errors = errors_at(evidence, next.theta);
    const double after = misfit(evidence, model, next);
    if (after < before - (set == point.set ? criteria.settled : 0)) {
      point = std::move(next);
      return true;
    }
  }
  return false;
}

// To the set of terms that the linear model chooses, or to one with fewer changes where that one does not hold so far
// off.
bool move_to_better(const Evidence& evidence, const LinearModel& model, const TermSet& allowed,
                    const SearchCriteria& criteria, Point& point) {
  ChoiceCriteria choice;
  TermSet before;
  for (; choice.most_new >= 0; --choice.most_new) {
    const TermSet set = choose_terms(model, point.set, allowed, choice);
    if (set == before) continue;
    if (move(evidence, model, set, criteria, point)) return true;
    before = set;
  }
  return before != point.set && move(evidence, model, point.set, criteria, point);
}

bool is_fresh(const Derivatives& derivatives, const TermSet& terms) {
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (terms[t] != 0 && derivatives.fresh[t] == 0) return false;
  }
  return true;
}

void trace(const Evidence& evidence, const Point& point) {
  if (std::getenv("ROBOT_TRACE") == nullptr) return;
  const Eigen::VectorXd rms = rms_by_joint(evidence, point.errors);
  std::fprintf(stderr, "rms %.5f:", std::sqrt(rms.squaredNorm() / static_cast<double>(rms.size())));
  for (std::size_t t = 0; t < point.set.size(); ++t) {
    if (point.set[t] == 0) continue;
    std::fprintf(stderr, " %s@%s=%.4g", info_of(evidence.terms[t].property).effect,
                 place_of(evidence.robot, evidence.terms[t]).c_str(), point.theta[static_cast<Eigen::Index>(t)]);
  }
  std::fprintf(stderr, "\n");
}

// The file as it stands.
Point start(const Evidence& evidence) {
  const auto terms = static_cast<Eigen::Index>(evidence.terms.size());
  Point point{Eigen::VectorXd::Zero(terms), TermSet(evidence.terms.size(), 0), {}};
  point.errors = errors_at(evidence, point.theta);
  return point;
}

// Takes the term away that held-out blocks want least, if they do not want it, or if it takes away no more than
// simulations of one model differ by.
bool drop_one(const Evidence& evidence, const LinearModel& model, const SearchCriteria& criteria, Point& point,
              std::vector<std::string>& dropped) {
  const HeldOutGain gain = held_out_gain(model, point.set);
  Eigen::Index worst = -1;
  double least = 1;
  for (Eigen::Index t = 0; t < gain.share.size(); ++t) {
    if (point.set[static_cast<std::size_t>(t)] == 0) continue;
    const Term& term = evidence.terms[static_cast<std::size_t>(t)];
    double numerical = 0;
    for (const int j : term.joints) {
      if (evidence.numerical.size() > 0)
        numerical += evidence.numerical[j] * evidence.numerical[j] / static_cast<double>(term.joints.size());
    }
    const double needed = criteria.times_numerical * std::sqrt(numerical);
    const double worth = std::min(gain.share[t] / criteria.smallest_gain, needed > 0 ? gain.taken[t] / needed : 1);
    if (worth >= least) continue;
    least = worth;
    worst = t;
  }
  if (worst < 0) return false;
  const Term& term = evidence.terms[static_cast<std::size_t>(worst)];
  dropped.push_back(std::string(info_of(term.property).effect) + " at " + place_of(evidence.robot, term) +
                    " was dropped: it takes " + diagnose_program::percent(gain.share[worst]) +
                    " off the error of its joints on held-out blocks, or less than simulations of one "
                    "model differ by");
  point.set[static_cast<std::size_t>(worst)] = 0;
  return true;
}

}  // namespace

SearchResult search_terms(const Evidence& evidence, const Progress& progress, const SearchCriteria& criteria) {
  Point point = start(evidence);
  const TermSet all(evidence.terms.size(), 1);
  TermSet allowed(evidence.terms.size(), 0);
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) allowed[t] = evidence.terms[t].group != single_joint ? 1 : 0;
  SearchResult result;
  bool singles = false, renew = false;
  Derivatives derivatives;
  for (int round = 0; round < criteria.most_rounds; ++round) {
    if (evidence.stop.stop_requested()) {
      result.complete = false;
      break;
    }
    progress(singles ? "single joints" : "groups", static_cast<double>(round) / criteria.most_rounds);
    trace(evidence, point);
    const LinearModel model = linearize(evidence, point.theta, point.errors, either(allowed, point.set),
                                        renew ? either(allowed, point.set) : point.set, derivatives);
    const bool stale = !renew && !is_fresh(derivatives, allowed);
    renew = false;
    if (move_to_better(evidence, model, allowed, criteria, point)) continue;
    if (stale) {  // derivatives of terms outside are those of an earlier point: once more with those of this one
      renew = true;
      continue;
    }
    if (singles && drop_one(evidence, model, criteria, point, result.dropped)) {
      for (std::size_t t = 0; t < point.set.size(); ++t) {
        if (point.set[t] == 0 && point.theta[static_cast<Eigen::Index>(t)] != 0) {
          allowed[t] = 0;
          point.theta[static_cast<Eigen::Index>(t)] = 0;
        }
      }
      point.errors = errors_at(evidence, point.theta);
      continue;
    }
    if (singles) break;
    singles = true;
    allowed = all;
  }
  progress("proof", 1);
  result.theta = point.theta;
  result.set = point.set;
  result.errors = point.errors;
  result.linear = linearize(evidence, point.theta, point.errors, all, all, derivatives);
  return result;
}

}  // namespace diagnose_robot
