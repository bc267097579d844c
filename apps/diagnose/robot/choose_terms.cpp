#include "choose_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace diagnose_robot {
namespace {

constexpr double indistinguishable = 4.16;  // -2 log of odds of 8, as for the diagnosis of one joint

TermSet changed(TermSet set, Eigen::Index term, bool in) {
  set[static_cast<std::size_t>(term)] = in ? 1 : 0;
  return set;
}

bool is_negligible(const LinearModel& model, const LinearFit& fit, Eigen::Index term) {
  return std::abs(model.theta[term] + fit.change[term]) < model.smallest[term];
}

struct Best {
  Eigen::Index term = -1;
  double criterion = std::numeric_limits<double>::infinity();
};

Eigen::Index negligible_term(const LinearModel& model, const LinearFit& fit, const TermSet& set) {
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] != 0 && is_negligible(model, fit, static_cast<Eigen::Index>(t))) return static_cast<Eigen::Index>(t);
  }
  return -1;
}

Best best_change(const LinearModel& model, const TermSet& set, const TermSet& allowed, bool add) {
  Best best;
  for (std::size_t t = 0; t < set.size(); ++t) {
    const bool may = add ? set[t] == 0 && allowed[t] != 0 : set[t] != 0;
    if (!may) continue;
    const LinearFit fit = fit_linear(model, changed(set, static_cast<Eigen::Index>(t), add));
    if (add && is_negligible(model, fit, static_cast<Eigen::Index>(t))) continue;
    const double criterion = fit.criterion;
    if (criterion < best.criterion) best = {static_cast<Eigen::Index>(t), criterion};
  }
  return best;
}

}  // namespace

TermSet choose_terms(const LinearModel& model, TermSet set, const TermSet& allowed, const ChoiceCriteria& criteria) {
  double now = fit_linear(model, set).criterion;
  for (int added = 0; added < criteria.most_new; ++added) {
    const Best best = best_change(model, set, allowed, true);
    if (best.term < 0 || best.criterion > now - criteria.needed) break;
    set = changed(set, best.term, true);
    now = best.criterion;
  }
  for (int swap = 0; swap < criteria.most_new; ++swap) {
    const std::vector<TermAlternative> others = alternatives_of(model, set, allowed);
    const auto best = std::ranges::min_element(others, {}, &TermAlternative::criterion);
    if (best == others.end() || best->criterion > -criteria.better) break;
    set = changed(changed(set, best->instead, false), best->other, true);
    now += best->criterion;
  }
  for (;;) {
    const Best best = best_change(model, set, allowed, false);
    if (best.term < 0) return set;
    const LinearFit fit = fit_linear(model, set);
    if (best.criterion > now + criteria.needed && !is_negligible(model, fit, best.term)) {
      const Eigen::Index other = negligible_term(model, fit, set);
      if (other < 0) return set;
      set = changed(set, other, false);
      now = fit_linear(model, set).criterion;
      continue;
    }
    set = changed(set, best.term, false);
    now = best.criterion;
  }
}

Eigen::VectorXd evidence_of_terms(const LinearModel& model, const TermSet& set) {
  Eigen::VectorXd result = Eigen::VectorXd::Constant(model.theta.size(), std::nan(""));
  const double now = fit_linear(model, set).criterion;
  for (Eigen::Index t = 0; t < result.size(); ++t) {
    if (set[static_cast<std::size_t>(t)] != 0) result[t] = fit_linear(model, changed(set, t, false)).criterion - now;
  }
  return result;
}

HeldOutGain held_out_gain(const LinearModel& model, const TermSet& set) {
  HeldOutGain result;
  result.share = result.taken = Eigen::VectorXd::Constant(model.theta.size(), std::nan(""));
  const std::size_t blocks = model.sums.front().size();
  std::vector<Eigen::VectorXd> with;
  for (std::size_t b = 0; b < blocks; ++b) with.push_back(fit_linear(model, set, static_cast<int>(b)).change);
  for (Eigen::Index t = 0; t < model.theta.size(); ++t) {
    if (set[static_cast<std::size_t>(t)] == 0) continue;
    double before = 0, after = 0, rows = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const Eigen::VectorXd without = fit_linear(model, changed(set, t, false), static_cast<int>(b)).change;
      for (const int j : model.acts_on[static_cast<std::size_t>(t)]) {
        const Sums& sums = model.sums[static_cast<std::size_t>(j)][b];
        before += square_after(sums, without);
        after += square_after(sums, with[b]);
        rows += sums.rows;
      }
    }
    result.share[t] = 1 - std::sqrt(std::max(0.0, after) / std::max(before, 1e-300));
    result.taken[t] = std::sqrt(std::max(0.0, before - after) / std::max(1.0, rows));
  }
  return result;
}

std::vector<TermAlternative> alternatives_of(const LinearModel& model, const TermSet& set, const TermSet& allowed) {
  std::vector<TermAlternative> result;
  const double now = fit_linear(model, set).criterion;
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] == 0) continue;
    const TermSet without = changed(set, static_cast<Eigen::Index>(t), false);
    for (std::size_t other = 0; other < set.size(); ++other) {
      if (set[other] != 0 || allowed[other] == 0) continue;
      const LinearFit fit = fit_linear(model, changed(without, static_cast<Eigen::Index>(other), true));
      const double criterion = fit.criterion - now;
      if (criterion < indistinguishable && !is_negligible(model, fit, static_cast<Eigen::Index>(other)))
        result.push_back({static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(other), criterion});
    }
  }
  return result;
}

}  // namespace diagnose_robot
