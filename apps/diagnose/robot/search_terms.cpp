#include "search_terms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "../wording.hpp"
#include "fewer_terms.hpp"
#include "findings.hpp"
#include "numerical_error.hpp"
#include "other_starts.hpp"
#include "search_point.hpp"

namespace diagnose_robot {
namespace {

// Whether terms would fit better with other sizes; starts alone, which follow them, are not worth another round.
bool sizes_change(const LinearModel& model, const TermSet& set) {
  Eigen::VectorXd square(static_cast<Eigen::Index>(model.whole.size()));
  for (Eigen::Index j = 0; j < square.size(); ++j) square[j] = model.whole[static_cast<std::size_t>(j)].square;
  const Eigen::VectorXd now = pooled_squares(model, square),
                        fitted = pooled_squares(model, fit_linear(model, set).square);
  return model.independent.dot((now.array() / fitted.array()).log().matrix()) > MoveCriteria().settled;
}

// To the set of terms that the linear model chooses, or to one with fewer changes where that one does not hold so far
// off; where none holds, without the terms that would have been added: they are not to be in the way of others.
bool move_to_better(const Evidence& evidence, const LinearModel& model, TermSet allowed, Point& point) {
  constexpr int most_barred = 6;  // times that new terms are left out
  constexpr int most_moves = 5;   // to where sizes no longer change: what is left on the way there is no evidence
  TermSet before;
  for (int barred = 0; barred <= most_barred; ++barred) {
    TermSet added(point.set.size(), 0);
    for (ChoiceCriteria choice; choice.most_new >= 0; --choice.most_new) {
      const TermSet set = choose_terms(model, point.set, allowed, choice);
      if (set == before) continue;
      if (move(evidence, model, set, {}, point)) {
        settle(evidence, model, most_moves, point);
        return true;
      }
      before = set;
      for (std::size_t t = 0; t < set.size() && choice.most_new > 0; ++t) added[t] = set[t] > point.set[t] ? 1 : 0;
    }
    if (std::ranges::count(added, 1) == 0) break;
    for (std::size_t t = 0; t < added.size(); ++t) {
      if (added[t] != 0) allowed[t] = 0;
    }
  }
  return before != point.set && sizes_change(model, point.set) && move(evidence, model, point.set, {}, point);
}

// The file as it stands.
Point start(const Evidence& evidence) {
  const auto terms = static_cast<Eigen::Index>(evidence.terms.size());
  Point point{Eigen::VectorXd::Zero(terms), TermSet(evidence.terms.size(), 0), evidence.starts, {}};
  point.errors = errors_at(evidence, point.theta, point.starts);
  return point;
}

using Worth = std::function<double(Eigen::Index)>;

// Takes the term away that is worth least, if that is less than it must be, and says why. What is never named need not
// be worth a name.
bool drop_one(const Evidence& evidence, const Worth& worth_of_term, const LinearModel& model, const std::string& why,
              Point& point, std::vector<std::string>& dropped) {
  Eigen::Index worst = -1;
  double least = 1;
  for (Eigen::Index t = 0; t < point.theta.size(); ++t) {
    const bool timing = is_of_timing(evidence.terms[static_cast<std::size_t>(t)].property);
    if (point.set[static_cast<std::size_t>(t)] == 0 || timing) continue;
    const double worth = worth_of_term(t);
    if (worth >= least) continue;
    least = worth;
    worst = t;
  }
  if (worst < 0) return false;
  const Term& term = evidence.terms[static_cast<std::size_t>(worst)];
  dropped.push_back(std::string(info_of(term.property).effect) + " at " + place_of(evidence.robot, term) +
                    " was dropped: it takes " +
                    diagnose_program::percent(held_out_gain(model, point.set, worst).share) +
                    " off the error of its joints on held-out blocks, " + why);
  point.set[static_cast<std::size_t>(worst)] = 0;
  point.theta[worst] = 0;
  return true;
}

// In the end, when nothing more is to be found: terms that are small beside what nothing explains, as small as they are
// uncertain, or smaller than anybody would correct a model for.
void leave_out_small(const Evidence& evidence, RigidCache& cache, Point& point, std::vector<std::string>& dropped) {
  Eigen::VectorXd noise = noise_by_joint(evidence, evidence.robot.nominal, 1);
  if (evidence.numerical.size() > 0) noise = (noise.cwiseAbs2() + evidence.numerical.cwiseAbs2()).cwiseSqrt();
  while (!evidence.stop.stop_requested()) {
    const LinearModel model = linearize(evidence, point.theta, point.starts, point.errors, cache);
    const Eigen::VectorXd error = standard_errors(model, point.set);
    const Worth worth = [&](Eigen::Index t) {
      const double size = std::abs(point.theta[t]);
      return std::min({worth_beside_unexplained(model, point.set, t, noise), size / (z95 * std::max(1e-300, error[t])),
                       size / model.smallest[t]});
    };
    if (!drop_one(evidence, worth, model,
                  "which is small beside what nothing explains, its interval contains 0, or nobody would correct a "
                  "model by so little",
                  point, dropped))
      return;
    point.errors = errors_at(evidence, point.theta, point.starts);
    const LinearModel without = linearize(evidence, point.theta, point.starts, point.errors, cache);
    move(evidence, without, point.set, {}, point);
  }
}

}  // namespace

SearchResult search_terms(const Evidence& given, const Progress& progress, const SearchCriteria& criteria) {
  Evidence evidence = given;
  Point point = start(evidence);
  double share = numerical_share(evidence, point.errors);  // of numerical errors
  evidence.numerical *= share;
  TermSet allowed(evidence.terms.size(), 1);
  SearchResult result;
  RigidCache cache;
  OtherStarts starts;
  TermSet simulated = point.set;  // of which numerical errors are known
  TermSet fitted = point.set;     // that fewer terms were tried instead of
  for (int round = 0; round < criteria.most_rounds; ++round) {
    if (evidence.stop.stop_requested()) {
      result.complete = false;
      break;
    }
    progress("search", static_cast<double>(round) / criteria.most_rounds);
    const LinearModel model = linearize(evidence, point.theta, point.starts, point.errors, cache);
    if (move_to_better(evidence, model, allowed, point)) continue;
    // Before a term is dropped for them: numerical errors are no more than what is left.
    const double room = cap_numerical_error(evidence, point.errors);
    share *= room;
    if (room < 1) continue;
    const TermSet before = point.set;
    const Worth worth = [&](Eigen::Index t) { return worth_of(model, point.set, t); };
    if (!drop_one(evidence, worth, model,
                  "or less than simulations of one model differ by, or only few blocks speak for it", point,
                  result.dropped)) {
      if (starts.try_next(evidence, model, point)) continue;
      if (fitted != point.set) {
        fitted = point.set;
        if (do_with_fewer(evidence, model, point)) continue;
      }
      if (simulated != point.set) {
        simulated = point.set;
        const RobotPhysics physics = physics_of(evidence.terms, point.theta, evidence.base);
        if (raise_numerical_error(evidence, physics, point.starts, point.errors, share)) continue;
      }
      const double larger = evidence.numerical.norm();
      if (!lower_numerical_error(evidence, point.errors)) break;
      share *= evidence.numerical.norm() / larger;
      allowed.assign(allowed.size(), 1);
      result.dropped.clear();
      continue;
    }
    for (std::size_t t = 0; t < before.size(); ++t) {
      if (before[t] != point.set[t]) allowed[t] = 0;
    }
    point.errors = errors_at(evidence, point.theta, point.starts);
  }
  leave_out_small(evidence, cache, point, result.dropped);
  progress("proof", 1);
  result.numerical = evidence.numerical;
  result.theta = point.theta;
  result.set = point.set;
  result.starts = point.starts;
  result.errors = point.errors;
  result.linear = linearize(evidence, point.theta, point.starts, point.errors, cache);
  return result;
}

}  // namespace diagnose_robot
