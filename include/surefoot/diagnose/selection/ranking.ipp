// Definitions of surefoot/diagnose/selection/ranking.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/ranking.hpp"

namespace surefoot::diagnosis {

/// Geometric mean of the errors of recordings: one that is far off, whatever the structure, does not hide the others.
SUREFOOT_ONCE double typical_error(const ErrorSquares& errors) {
  constexpr double smallest = 1e-300;  // mean square: exact
  double logs = 0, recordings = 0;
  for (Eigen::Index r = 0; r < errors.counts.rows(); ++r) {
    double squares = 0, cells = 0;
    for (Eigen::Index k = 0; k < errors.counts.cols(); ++k) {
      squares += errors.mean_squares(r, k) * errors.counts(r, k);
      cells += errors.counts(r, k);
    }
    if (!(cells > 0)) continue;
    logs += std::log(std::max(squares / cells, smallest));
    ++recordings;
  }
  return recordings > 0 ? std::exp(logs / (2 * recordings)) : 0;
}

SUREFOOT_ONCE const EvaluatedHypothesis& clearly_nearest(const Selection& selection) {
  const EvaluatedHypothesis* nearest = &selection.chosen;
  double least = clearly_nearer * typical_error(selection.chosen.errors);
  for (const EvaluatedHypothesis& one : selection.alternatives) {
    const double error = typical_error(one.errors);
    if (!(error < least)) continue;
    least = error;
    nearest = &one;
  }
  return *nearest;
}

SUREFOOT_ONCE Comparison gain_of(const ErrorSquares& before, const ErrorSquares& after, double log_odds) {
  constexpr double least_ratio = 1e-6;  // of errors: below, the second one is exact
  constexpr double largest_odds = 700;  // [nat]: exp would overflow
  Comparison result;
  if (!(before.rms() > 0)) return result;
  const Eigen::VectorXd size = pooled(before);
  const auto in_sizes = [&](const ErrorSquares& errors, Eigen::Index r, Eigen::Index k) {
    return size[k] > 0 ? before.counts(r, k) * errors.mean_squares(r, k) / size[k] : 0.0;
  };
  double all = 0, left = 0;
  for (Eigen::Index r = 0; r < before.counts.rows(); ++r) {
    for (Eigen::Index k = 0; k < before.counts.cols(); ++k) {
      all += in_sizes(before, r, k);
      left += in_sizes(after, r, k);
    }
  }
  const double share = left / all, ratio = std::sqrt(share);
  result.gain = 1 - ratio;
  double squares = 0;
  for (Eigen::Index r = 0; r < before.counts.rows(); ++r) {
    double off = 0;
    for (Eigen::Index k = 0; k < before.counts.cols(); ++k) off += in_sizes(after, r, k) - share * in_sizes(before, r, k);
    squares += off * off;
  }
  result.stderr_ = std::sqrt(squares) / all / (2 * std::max(ratio, least_ratio));
  result.t = result.stderr_ > 0 ? result.gain / result.stderr_ : 0;
  result.p_value = 1 / (1 + std::exp(std::clamp(log_odds, -largest_odds, largest_odds)));
  return result;
}

SUREFOOT_ONCE std::size_t closest_of_tie(const Search& search, const std::vector<EvaluatedHypothesis>& pool,
                                         const std::vector<double>& share, std::size_t best) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const auto as_it_is = [&](std::size_t i) {
    EvaluatedHypothesis one = pool[i];
    forget_errors_of_form(one.errors);
    return one;
  };
  std::size_t closest = best;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    if (share[i] * criteria.tie_odds < share[best] || search.effects(pool[i]) == 0) continue;
    if (pool[i].parameter_count() > pool[best].parameter_count()) continue;
    if (log_odds(as_it_is(i), as_it_is(closest), criteria) > 0) closest = i;
  }
  return closest;
}

/// The effects of a hypothesis that a part of it does not have.
SUREFOOT_ONCE std::vector<std::string> labels_beyond(const Hypothesis& whole, const Hypothesis& part) {
  const std::vector<std::string> kept = structure_of(part);
  std::vector<std::string> dropped;
  std::size_t next = 0;  // of those kept
  for (const std::string& label : structure_of(whole)) {
    if (next < kept.size() && kept[next] == label) {
      ++next;
    } else {
      dropped.push_back(label);
    }
  }
  return dropped;
}

SUREFOOT_ONCE std::size_t without_improbable(const Search& search, const std::vector<EvaluatedHypothesis>& pool,
                                             const std::vector<double>& share, std::size_t whole) {
  constexpr double probable = 0.5;  // than not
  const double most = *std::max_element(share.begin(), share.end());
  const auto improbable = [&](const std::string& effect) {
    double with = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
      const std::vector<std::string> labels = structure_of(pool[i].hypothesis);
      with += std::find(labels.begin(), labels.end(), effect) != labels.end() ? share[i] : 0;
    }
    return with < probable;
  };
  const bool explains_all = leaves_only_noise(pool[whole], search.problem);
  std::size_t best = whole;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    const bool tied = share[i] * search.problem.criteria.tie_odds >= most;
    if (!tied || search.effects(pool[i]) == 0 || !is_part_of(pool[i].hypothesis, pool[whole].hypothesis)) continue;
    if (!holds_for_all(labels_beyond(pool[whole].hypothesis, pool[i].hypothesis), improbable)) continue;
    if (explains_all && !leaves_only_noise(pool[i], search.problem)) continue;
    if (best == whole || share[i] > share[best]) best = i;
  }
  return best;
}

SUREFOOT_ONCE Selection ranked(const Search& search, const std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const std::vector<double> share = probabilities(pool, criteria);
  std::vector<std::size_t> order(pool.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  sort_items(order, [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
  Selection selection;
  selection.candidates = search.problem.candidates;
  double without = 0;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    if (search.effects(pool[i]) > 0) continue;
    selection.nominal = pool[i];
    without = share[i];
  }
  // What residuals show to be missing anyway is named as far as it stands out: the verdict says that this is a part.
  const bool refuted = search.problem.structured(selection.nominal.hypothesis, search.problem.fit);
  const bool something =
      1 - without > criteria.named_odds * without || (refuted && share[order.front()] > criteria.tie_odds * without);
  const bool named = something && search.effects(pool[order.front()]) > 0;
  const std::size_t first = without_improbable(search, pool, share, closest_of_tie(search, pool, share, order.front()));
  selection.chosen = named ? pool[first] : selection.nominal;
  selection.probability = named ? share[first] : without;
  for (const std::size_t i : order) {
    if (same_structure(pool[i].hypothesis, selection.chosen.hypothesis)) continue;
    selection.alternatives.push_back(pool[i]);
    selection.alternative_probabilities.push_back(share[i]);
  }
  return selection;
}

}  // namespace surefoot::diagnosis
