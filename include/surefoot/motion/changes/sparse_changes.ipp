// Definitions of surefoot/motion/changes/sparse_changes.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/motion/changes/sparse_changes.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const SparseChangeOptions& options) {
  if (!(options.nothing > 0 && options.nothing < 1)) {
    throw MotionError("SparseChangeOptions: nothing must be between 0 and 1, got " + std::to_string(options.nothing));
  }
  if (options.largest_set < 1 || options.enlarged < 1 || !(options.negligible >= 0)) {
    throw MotionError("SparseChangeOptions: largest_set and enlarged must be at least 1, negligible at least 0");
  }
}

SUREFOOT_INLINE double ChangePosterior::any_of(std::span<const int> changes) const {
  double sum = 0;
  for (const ChangeSet& set : sets) {
    const bool one = std::ranges::any_of(changes, [&](int change) {
      return change < 0 ? set.delay != 0 : std::ranges::binary_search(set.members, change);
    });
    if (one) sum += set.probability;
  }
  return sum;
}

namespace detail {

/// What the difference says about changes of coefficients, worked out once for all sets.
class ChangeEvidence {
 public:
  ChangeEvidence(const DifferenceEvidence& evidence, std::span<const WalkChange> changes)
      : evidence_(evidence), changes_(changes), count_(static_cast<Eigen::Index>(changes.size())) {
    const Eigen::VectorXd weighted = product(evidence.information, evidence.difference);
    squared_ = dot(weighted.data(), evidence.difference.data(), weighted.size());
    gram_ = Eigen::MatrixXd::Zero(count_, count_);
    along_ = Eigen::VectorXd::Zero(count_);
    for (Eigen::Index i = 0; i < count_; ++i) {
      const Eigen::VectorXd& direction = changes[static_cast<std::size_t>(i)].direction;
      if (direction.size() == 0) continue;
      along_[i] = dot(direction.data(), weighted.data(), weighted.size());
      const Eigen::VectorXd seen = product(evidence.information, direction);
      for (Eigen::Index j = 0; j < count_; ++j) {
        const Eigen::VectorXd& other = changes[static_cast<std::size_t>(j)].direction;
        if (other.size() > 0) gram_(i, j) = dot(seen.data(), other.data(), seen.size());
      }
    }
  }

  /// Those of the members that change coefficients.
  std::vector<int> of_coefficients(std::span<const int> members) const {
    std::vector<int> result;
    for (const int i : members) {
      if (changes_[static_cast<std::size_t>(i)].direction.size() > 0) result.push_back(i);
    }
    return result;
  }

  /// Information about the sizes of these changes, the prior included.
  Cholesky information(std::span<const int> members) const {
    const auto n = static_cast<Eigen::Index>(members.size());
    Eigen::MatrixXd information(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const int a = members[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < n; ++j) information(i, j) = gram_(a, members[static_cast<std::size_t>(j)]);
      const double deviation = changes_[static_cast<std::size_t>(a)].deviation;
      information(i, i) += 1 / (deviation * deviation);
    }
    return Cholesky(information);
  }

  Eigen::VectorXd along(std::span<const int> members) const {
    Eigen::VectorXd result(static_cast<Eigen::Index>(members.size()));
    for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = along_[members[static_cast<std::size_t>(i)]];
    return result;
  }

  /// Squared distance of the difference from what the set predicts, in units of what is to be expected.
  double left(const Cholesky& root, const Eigen::VectorXd& along) const {
    const Eigen::VectorXd part = root.solve_lower(along);
    return std::max(0.0, squared_ - squared_norm(part));
  }

  /// Of the set against no change [nats].
  double log_bayes_factor(std::span<const int> members) const {
    double result = 0;
    for (const int i : members) result += changes_[static_cast<std::size_t>(i)].log_bayes_factor;
    const std::vector<int> coefficients = of_coefficients(members);
    if (coefficients.empty()) return result;
    const Cholesky root = information(coefficients);
    if (!root.ok()) return -std::numeric_limits<double>::infinity();
    result -= root.half_log_determinant();
    for (const int i : coefficients) result -= std::log(changes_[static_cast<std::size_t>(i)].deviation);
    const double nu = evidence_.freedoms, half = 0.5 * (nu + static_cast<double>(evidence_.difference.size()));
    return result + half * (std::log1p(squared_ / nu) - std::log1p(left(root, along(coefficients)) / nu));
  }

  double squared() const { return squared_; }
  double gram(int change) const { return gram_(change, change); }

 private:
  const DifferenceEvidence& evidence_;
  std::span<const WalkChange> changes_;
  Eigen::Index count_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd along_;
  double squared_ = 0;
};

/// Prior probabilities of sets of changes.
class SetPrior {
 public:
  SetPrior(std::span<const WalkChange> changes, bool delays, const SparseChangeOptions& options)
      : nothing_(options.nothing) {
    for (const WalkChange& change : changes) weights_.push_back(change.weight);
    weights_.push_back(delays ? options.delay_weight : 0);
    sums_.assign(weights_.size() + 1, 0);
    sums_[0] = 1;
    for (const double weight : weights_) {
      for (std::size_t size = sums_.size() - 1; size > 0; --size) sums_[size] += weight * sums_[size - 1];
    }
  }

  /// Logarithm of the probability of this set, with a delay or without one.
  double log_probability(std::span<const int> members, bool delayed) const {
    const std::size_t size = members.size() + (delayed ? 1 : 0);
    if (size == 0) return std::log(nothing_);
    double result = std::log(1 - nothing_) - static_cast<double>(size) * std::log(2.0) - std::log(sums_[size]);
    for (const int i : members) result += std::log(weights_[static_cast<std::size_t>(i)]);
    return delayed ? result + std::log(weights_.back()) : result;
  }

 private:
  double nothing_;
  std::vector<double> weights_, sums_;  // of each change, the delay last; of all products of so many of them
};

struct WeightedSet {
  std::vector<int> members;
  double log_weight = 0;
};

/// Sets with one member more than one of these.
SUREFOOT_INLINE std::set<std::vector<int>> enlarged(std::span<const WeightedSet> sets, int changes) {
  std::set<std::vector<int>> result;
  for (const WeightedSet& set : sets) {
    for (int i = 0; i < changes; ++i) {
      std::vector<int> members = set.members;
      const auto place = std::ranges::lower_bound(members, i);
      if (place != members.end() && *place == i) continue;
      members.insert(place, i);
      result.insert(std::move(members));
    }
  }
  return result;
}

SUREFOOT_INLINE double log_sum(const std::vector<WeightedSet>& sets) {
  double largest = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const WeightedSet& set : sets) largest = std::max(largest, set.log_weight);
  for (const WeightedSet& set : sets) sum += std::exp(set.log_weight - largest);
  return largest + std::log(sum);
}

/// All sets that were looked at for one delay.
SUREFOOT_INLINE std::vector<WeightedSet> search_sets(const DifferenceEvidence& evidence,
                                                     std::span<const WalkChange> changes, int delays,
                                                     const SparseChangeOptions& options) {
  const ChangeEvidence data(evidence, changes);
  const auto count = static_cast<int>(changes.size());
  const bool delayed = evidence.delay != 0;
  const double base = evidence.log_evidence - (delayed ? std::log(delays - 1.0) : 0.0);
  const SetPrior prior(changes, delays > 1, options);
  const auto weight = [&](const std::vector<int>& members) {
    return base + prior.log_probability(members, delayed) + data.log_bayes_factor(members);
  };
  std::vector<WeightedSet> all{{{}, weight({})}}, best = all;
  for (int size = 1; size <= std::min(options.largest_set, count); ++size) {
    std::vector<WeightedSet> level;
    for (const std::vector<int>& members : enlarged(best, count)) level.push_back({members, weight(members)});
    std::ranges::stable_sort(level, std::ranges::greater{}, &WeightedSet::log_weight);
    const bool pairs_seen = size > 2;
    const bool over = pairs_seen && log_sum(level) < log_sum(all) + std::log(options.negligible);
    all.insert(all.end(), level.begin(), level.end());
    if (over) break;
    level.resize(std::min(level.size(), static_cast<std::size_t>(options.enlarged)));
    best = std::move(level);
  }
  return all;
}

}  // namespace detail

SUREFOOT_INLINE ChangePosterior posterior_of_changes(std::span<const DifferenceEvidence> by_delay,
                                                     std::span<const WalkChange> changes,
                                                     const SparseChangeOptions& options) {
  check(options);
  if (by_delay.empty() || by_delay.front().delay != 0) {
    throw MotionError("posterior_of_changes: the evidence without a delay must come first");
  }
  ChangePosterior result;
  std::vector<detail::WeightedSet> all;
  for (const DifferenceEvidence& evidence : by_delay) {
    for (detail::WeightedSet& set :
         detail::search_sets(evidence, changes, static_cast<int>(by_delay.size()), options)) {
      result.sets.push_back({.delay = evidence.delay, .members = set.members, .probability = set.log_weight});
      all.push_back(std::move(set));
    }
  }
  const double total = detail::log_sum(all);
  result.inclusion = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(changes.size()));
  for (ChangeSet& set : result.sets) {
    set.probability = std::exp(set.probability - total);
    for (const int member : set.members) result.inclusion[member] += set.probability;
    if (set.members.empty() && set.delay == 0) result.nothing += set.probability;
  }
  std::ranges::stable_sort(result.sets, std::ranges::greater{}, &ChangeSet::probability);
  return result;
}

SUREFOOT_INLINE ChangeSizes change_sizes(const DifferenceEvidence& evidence, std::span<const WalkChange> changes,
                                         std::span<const int> members) {
  const detail::ChangeEvidence data(evidence, changes);
  const std::vector<int> coefficients = data.of_coefficients(members);
  const auto count = static_cast<Eigen::Index>(members.size());
  ChangeSizes result{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  if (coefficients.empty()) return result;
  const detail::Cholesky root = data.information(coefficients);
  const Eigen::VectorXd along = data.along(coefficients), sizes = root.solve(along);
  const Eigen::MatrixXd covariance = root.inverse();
  const double nu = evidence.freedoms;
  const double scale = (nu + data.left(root, along)) / (nu + static_cast<double>(evidence.difference.size()));
  Eigen::Index next = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (changes[static_cast<std::size_t>(members[static_cast<std::size_t>(i)])].direction.size() == 0) continue;
    result.size[i] = sizes[next];
    result.standard_error[i] = std::sqrt(scale * covariance(next, next));
    ++next;
  }
  return result;
}

// Solves log Bayes factor = threshold for a difference that is that change and nothing else, and adds what chance takes
// away in 1 of 20 comparisons.
SUREFOOT_INLINE double smallest_detectable(const DifferenceEvidence& evidence, std::span<const WalkChange> changes,
                                           int change, double certainty, const SparseChangeOptions& options) {
  constexpr double one_in_20 = 1.645;  // quantile of the normal distribution
  const WalkChange& one = changes[static_cast<std::size_t>(change)];
  if (one.direction.size() == 0) return std::numeric_limits<double>::infinity();
  const double seen = detail::ChangeEvidence(evidence, changes).gram(change);
  const double gain = 1 + seen * one.deviation * one.deviation;
  const detail::SetPrior prior(changes, true, options);
  const double prior_odds = prior.log_probability({}, false) - prior.log_probability(std::span(&change, 1), false);
  const double needed = std::log(certainty / (1 - certainty)) + prior_odds + 0.5 * std::log(gain);
  const double sum = evidence.freedoms + static_cast<double>(evidence.difference.size());
  const double ratio = std::exp(2 * needed / sum);
  if (!(ratio < gain)) return std::numeric_limits<double>::infinity();
  return std::sqrt(sum * (ratio - 1) / (1 - ratio / gain) / seen) + one_in_20 / std::sqrt(seen);
}

}  // namespace surefoot
