#include "choose_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surefoot/core/rng.hpp"

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
  Eigen::VectorXd square = {};  // errors that are left, by joint
};

HeldOutGain gain_of(double before, double after, double rows) {
  return {1 - std::sqrt(std::max(0.0, after) / std::max(before, 1e-300)),
          std::sqrt(std::max(0.0, before - after) / std::max(1.0, rows))};
}

// By its share of the errors, and what it takes against the difference of two simulations of one model.
double worth_of(const HeldOutGain& gain, const LinearModel& model, Eigen::Index term, const ChoiceCriteria& criteria) {
  const double worth = gain.share / criteria.smallest_gain;
  if (model.least_taken.size() == 0 || !(model.least_taken[term] > 0)) return worth;
  return std::min(worth, gain.taken / model.least_taken[term]);
}

Eigen::Index negligible_term(const LinearModel& model, const LinearFit& fit, const TermSet& set) {
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] != 0 && is_negligible(model, fit, static_cast<Eigen::Index>(t))) return static_cast<Eigen::Index>(t);
  }
  return -1;
}

// Whether each term that refines another one has it.
bool is_nested(const LinearModel& model, const TermSet& set) {
  for (std::size_t t = 0; t < set.size() && !model.refines.empty(); ++t) {
    const std::vector<Eigen::Index>& bases = model.refines[t];
    if (set[t] == 0 || bases.empty()) continue;
    if (std::ranges::none_of(bases, [&](Eigen::Index base) { return set[static_cast<std::size_t>(base)] != 0; }))
      return false;
  }
  return true;
}

// Sets with one term more or less, the most probable first.
std::vector<Best> changes(const LinearModel& model, const TermSet& set, const TermSet& allowed, bool add) {
  std::vector<Best> result;
  for (std::size_t t = 0; t < set.size(); ++t) {
    const auto term = static_cast<Eigen::Index>(t);
    const bool may = add ? set[t] == 0 && allowed[t] != 0 : set[t] != 0;
    if (!may || !is_nested(model, changed(set, term, add))) continue;
    const LinearFit fit = fit_linear(model, changed(set, term, add));
    if (!add || !is_negligible(model, fit, term)) result.push_back({term, fit.criterion, fit.square});
  }
  std::ranges::stable_sort(result, {}, &Best::criterion);
  return result;
}

// Whether a term takes as much as it must off the errors that it is fitted to. Held-out blocks see less of it, so that
// one which does not is worth too little, however probable many small errors make it.
bool may_be_worth(const LinearModel& model, const Eigen::VectorXd& without, const Eigen::VectorXd& with,
                  Eigen::Index term, const ChoiceCriteria& criteria) {
  double before = 0, after = 0, rows = 0;
  for (const int j : model.acts_on[static_cast<std::size_t>(term)]) {
    before += without[j];
    after += with[j];
    rows += model.whole[static_cast<std::size_t>(j)].rows;
  }
  return worth_of(gain_of(before, after, rows), model, term, criteria) > 1;
}

// The most probable term to add that is worth it.
Best best_addition(const LinearModel& model, const TermSet& set, const TermSet& allowed,
                   const ChoiceCriteria& criteria) {
  int tried = 0;
  const Eigen::VectorXd without = fit_linear(model, set).square;
  for (const Best& one : changes(model, set, allowed, true)) {
    if (!may_be_worth(model, without, one.square, one.term, criteria)) continue;
    if (tried++ == criteria.tried) break;
    if (worth_of(model, changed(set, one.term, true), one.term, criteria) > 1) return one;
  }
  return {};
}

bool share_joint(const LinearModel& model, Eigen::Index a, Eigen::Index b) {
  const auto& first = model.acts_on[static_cast<std::size_t>(a)];
  const auto& second = model.acts_on[static_cast<std::size_t>(b)];
  return std::ranges::any_of(first, [&](int j) { return std::ranges::find(second, j) != second.end(); });
}

struct Pair {
  Eigen::Index a = 0, b = 0;
  double criterion = 0;
};

// Pairs to add that act on a joint together, the most probable first.
std::vector<Pair> pairs_to_add(const LinearModel& model, const TermSet& set, const TermSet& allowed,
                               const ChoiceCriteria& criteria) {
  std::vector<Best> first = changes(model, set, allowed, true);
  if (first.size() > static_cast<std::size_t>(criteria.paired)) first.resize(static_cast<std::size_t>(criteria.paired));
  std::vector<Pair> pairs;
  for (const Best& one : first) {
    const TermSet more = changed(set, one.term, true);
    for (const Best& other : changes(model, more, allowed, true)) {
      if (!share_joint(model, one.term, other.term)) continue;
      pairs.push_back({one.term, other.term, other.criterion});
      break;
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::criterion);
  return pairs;
}

// Two terms of which neither is worth it without the other, as more dry friction and less damping than stated: the most
// probable pair that is worth it, or the set as it was.
TermSet with_best_pair(const LinearModel& model, const TermSet& set, const TermSet& allowed,
                       const ChoiceCriteria& criteria) {
  for (const Pair& pair : pairs_to_add(model, set, allowed, criteria)) {
    const TermSet both = changed(changed(set, pair.a, true), pair.b, true);
    if (evidence_between(model, both, set) > 2 * criteria.needed && worth_of(model, both, pair.a, criteria) > 1 &&
        worth_of(model, both, pair.b, criteria) > 1)
      return both;
  }
  return set;
}

// One term in the place of two, where that is more probable.
TermSet with_one_for_two(const LinearModel& model, const TermSet& set, const TermSet& allowed) {
  double least = fit_linear(model, set).criterion;
  TermSet best = set;
  for (std::size_t a = 0; a < set.size(); ++a) {
    for (std::size_t b = a + 1; b < set.size() && set[a] != 0; ++b) {
      const auto one = static_cast<Eigen::Index>(a), two = static_cast<Eigen::Index>(b);
      if (set[b] == 0 || !share_joint(model, one, two)) continue;
      const TermSet less = changed(changed(set, one, false), two, false);
      const std::vector<Best> instead = changes(model, less, allowed, true);
      if (instead.empty() || instead.front().criterion >= least) continue;
      least = instead.front().criterion;
      best = changed(less, instead.front().term, true);
    }
  }
  return best;
}

// Two terms in the place of one that stands for a bit of both, where that is more probable by what a term needs.
TermSet with_two_for_one(const LinearModel& model, const TermSet& set, const TermSet& allowed,
                         const ChoiceCriteria& criteria) {
  double least = fit_linear(model, set).criterion - criteria.needed;
  TermSet best = set;
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] == 0) continue;
    const TermSet less = changed(set, static_cast<Eigen::Index>(t), false);
    TermSet others = allowed;
    others[t] = 0;
    for (const Pair& pair : pairs_to_add(model, less, others, criteria)) {
      if (pair.criterion >= least) break;
      const TermSet both = changed(changed(less, pair.a, true), pair.b, true);
      if (!(worth_of(model, both, pair.a, criteria) > 1 && worth_of(model, both, pair.b, criteria) > 1)) continue;
      least = pair.criterion;
      best = both;
      break;
    }
  }
  return best;
}

// The most probable term outside in the place of one inside, if it is more probable and worth it itself, or as much as
// the other one: of two that explain different errors, that of the smaller ones is no alternative.
TermSet with_better_alternative(const LinearModel& model, const TermSet& set, const TermSet& allowed,
                                const ChoiceCriteria& criteria) {
  std::vector<TermAlternative> others = alternatives_of(model, set, allowed);
  std::ranges::stable_sort(others, {}, &TermAlternative::criterion);
  for (const TermAlternative& one : others) {
    if (one.criterion > -criteria.better) break;
    const TermSet exchanged = changed(changed(set, one.instead, false), one.other, true);
    const double needed = std::min(1.0, worth_of(model, set, one.instead, criteria));
    if (worth_of(model, exchanged, one.other, criteria) >= needed) return exchanged;
  }
  return set;
}

// Sums of squares that terms take away, by block (row) and joint, in units of `size`, each independent error once.
Eigen::MatrixXd taken_by_block(const LinearModel& model, const LinearFit& with, const LinearFit& without,
                               const Eigen::VectorXd& independent, const Eigen::VectorXd& size) {
  const auto joints = static_cast<Eigen::Index>(model.sums.size());
  const auto blocks = static_cast<Eigen::Index>(model.sums.front().size());
  Eigen::MatrixXd taken(blocks, joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const auto joint = static_cast<std::size_t>(j);
    const double weight = independent[j] / (size[j] * std::max(1.0, model.whole[joint].rows));
    for (Eigen::Index b = 0; b < blocks; ++b) {
      const Sums& sums = model.sums[joint][static_cast<std::size_t>(b)];
      taken(b, j) = weight * (square_after(sums, without.change) - square_after(sums, with.change));
    }
  }
  return taken;
}

}  // namespace

double evidence_between(const LinearModel& model, const TermSet& with, const TermSet& without) {
  constexpr int rounds = 400;  // of the bootstrap: probabilities are off by 2.5 % at most
  const LinearFit more = fit_linear(model, with), less = fit_linear(model, without);
  const Eigen::VectorXd size = pooled_squares(model, more.square);
  const Eigen::VectorXd ratio = (pooled_squares(model, less.square).array() / size.array()).log();
  const Eigen::VectorXd independent = independent_after(model, with);
  const double likelihood = independent.dot(ratio);
  const double cost = model.independent.dot(ratio) - (less.criterion - more.criterion);
  const Eigen::MatrixXd taken = taken_by_block(model, more, less, independent, size);
  const double all = taken.sum();
  if (!(all > 0) || !(likelihood > 0)) return likelihood - cost;
  surefoot::Rng rng(1);  // the same draws for all
  double probability = 0;
  for (int round = 0; round < rounds; ++round) {
    double sum = 0, weights = 0;
    for (const double cell : taken.reshaped()) {
      const double weight = -std::log(1 - rng.uniform());
      sum += weight * cell;
      weights += weight;
    }
    const double drawn = sum / weights * static_cast<double>(taken.size()) / all * likelihood - cost;
    probability += 1 / (1 + std::exp(-drawn / 2)) / rounds;
  }
  constexpr double certain = 1e-12;
  return 2 * std::log(std::max(probability, certain) / std::max(1 - probability, certain));
}

TermSet choose_terms(const LinearModel& model, TermSet set, const TermSet& allowed, const ChoiceCriteria& criteria) {
  const TermSet begin = set;
  for (int added = 0; added < criteria.most_new; ++added) {
    const Best best = best_addition(model, set, allowed, criteria);
    if (best.term < 0) break;
    set = changed(set, best.term, true);
  }
  if (set == begin && criteria.most_new > 0) set = with_best_pair(model, set, allowed, criteria);
  if (set == begin && criteria.most_new > 0) set = with_one_for_two(model, set, allowed);
  if (set == begin && criteria.most_new > 0) set = with_two_for_one(model, set, allowed, criteria);
  for (int swap = 0; swap < criteria.most_new; ++swap) {
    const TermSet before = set;
    set = with_better_alternative(model, set, allowed, criteria);
    if (set == before) break;
  }
  for (;;) {
    const std::vector<Best> less = changes(model, set, allowed, false);
    if (less.empty()) return set;
    const LinearFit fit = fit_linear(model, set);
    Eigen::Index out = less.front().term;
    const TermSet without = changed(set, out, false);
    if (!is_negligible(model, fit, out) && evidence_between(model, set, without) > criteria.needed)
      out = negligible_term(model, fit, set);
    if (out < 0) return set;
    set = changed(set, out, false);
  }
}

Eigen::VectorXd evidence_of_terms(const LinearModel& model, const TermSet& set) {
  Eigen::VectorXd result = Eigen::VectorXd::Constant(model.theta.size(), std::nan(""));
  for (Eigen::Index t = 0; t < result.size(); ++t) {
    if (set[static_cast<std::size_t>(t)] != 0) result[t] = evidence_between(model, set, changed(set, t, false));
  }
  return result;
}

HeldOutGain held_out_gain(const LinearModel& model, const TermSet& set, Eigen::Index term) {
  double before = 0, after = 0, rows = 0;
  for (std::size_t b = 0; b < model.sums.front().size(); ++b) {
    const int block = static_cast<int>(b);
    const Eigen::VectorXd with = fit_linear(model, set, block).change,
                          without = fit_linear(model, changed(set, term, false), block).change;
    for (const int j : model.acts_on[static_cast<std::size_t>(term)]) {
      const Sums& sums = model.sums[static_cast<std::size_t>(j)][b];
      before += square_after(sums, without);
      after += square_after(sums, with);
      rows += sums.rows;
    }
  }
  return gain_of(before, after, rows);
}

double worth_of(const LinearModel& model, const TermSet& set, Eigen::Index term, const ChoiceCriteria& criteria) {
  const double worth = worth_of(held_out_gain(model, set, term), model, term, criteria);
  if (worth < 1) return worth;
  return std::min(worth, evidence_between(model, set, changed(set, term, false)) / criteria.needed);
}

double worth_beside_unexplained(const LinearModel& model, const TermSet& set, Eigen::Index term,
                                const Eigen::VectorXd& noise) {
  constexpr double errors_of_form = 0.95;  // what is left of them by an effect that may be one, as for one joint
  const Eigen::VectorXd left = fit_linear(model, set).square;
  double unexplained = 0, rows = 0;
  for (const int j : model.acts_on[static_cast<std::size_t>(term)]) {
    const double count = model.whole[static_cast<std::size_t>(j)].rows;
    unexplained += std::max(0.0, left[j] - count * noise[j] * noise[j]);
    rows += count;
  }
  unexplained *= 1 / (errors_of_form * errors_of_form) - 1;
  const double wanted = std::sqrt(unexplained / std::max(1.0, rows));
  return held_out_gain(model, set, term).taken / std::max(1e-300, wanted);
}

bool explain_the_same(const LinearModel& model, const TermSet& set, const TermAlternative& tie) {
  constexpr double half = 0.5;
  const double now = fit_linear(model, set).criterion,
               without = fit_linear(model, changed(set, tie.instead, false)).criterion,
               with_both = fit_linear(model, changed(set, tie.other, true)).criterion;
  return now - with_both < half * (without - now);
}

std::vector<TermAlternative> alternatives_of(const LinearModel& model, const TermSet& set, const TermSet& allowed) {
  std::vector<TermAlternative> result;
  const double now = fit_linear(model, set).criterion;
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] == 0) continue;
    const TermSet without = changed(set, static_cast<Eigen::Index>(t), false);
    for (std::size_t other = 0; other < set.size(); ++other) {
      if (set[other] != 0 || allowed[other] == 0) continue;
      const TermSet exchanged = changed(without, static_cast<Eigen::Index>(other), true);
      if (!is_nested(model, exchanged)) continue;
      const LinearFit fit = fit_linear(model, exchanged);
      const double criterion = fit.criterion - now;
      if (criterion < indistinguishable && !is_negligible(model, fit, static_cast<Eigen::Index>(other)))
        result.push_back({static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(other), criterion});
    }
  }
  return result;
}

}  // namespace diagnose_robot
