// Definitions of surefoot/diagnose/selection/pairs.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/selection/pairs.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Shares of signatures within their limits that explain most, and what they explain.
struct Shares {
  Eigen::VectorXd value;
  double gain = 0;
};

SUREFOOT_INLINE double explained_by(const Eigen::MatrixXd& gram, const Eigen::VectorXd& against,
                                    const Eigen::VectorXd& share) {
  double gain = 0;
  for (Eigen::Index k = 0; k < against.size(); ++k) {
    double curved = 0;
    for (Eigen::Index j = 0; j < against.size(); ++j) curved += gram(k, j) * share[j];
    gain -= share[k] * (2 * against[k] + curved);
  }
  return gain;
}

/// Minimises value' gram value / 2 + against' value in a box: at once if the minimum lies within, else one coordinate
/// after the other.
SUREFOOT_INLINE Shares best_shares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& against,
                                   const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  constexpr int sweeps = 60;  // a rank needs no more
  Shares shares{surefoot::detail::solve_symmetric(gram, against)};
  bool within = surefoot::all_finite(shares.value);
  for (Eigen::Index k = 0; k < against.size(); ++k) {
    shares.value[k] = -shares.value[k];
    within = within && shares.value[k] >= low[k] && shares.value[k] <= high[k];
  }
  if (within) {
    shares.gain = explained_by(gram, against, shares.value);
    return shares;
  }
  for (Eigen::Index k = 0; k < against.size(); ++k) shares.value[k] = std::clamp(0.0, low[k], high[k]);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Eigen::Index k = 0; k < against.size(); ++k) {
      if (!(gram(k, k) > 0)) continue;
      double slope = against[k];
      for (Eigen::Index j = 0; j < against.size(); ++j) slope += gram(k, j) * shares.value[j];
      shares.value[k] = std::clamp(shares.value[k] - slope / gram(k, k), low[k], high[k]);
    }
  }
  shares.gain = explained_by(gram, against, shares.value);
  return shares;
}

/// A proposal that starts with shares of what it was screened with, from place `from` on.
SUREFOOT_ONCE Proposal started(const Proposal& proposal, const Eigen::VectorXd& shares, Eigen::Index from) {
  Proposal result = proposal;
  const std::vector<Eigen::Index> strengths = strengths_of(*proposal.effect.effect);
  for (std::size_t m = 0; m < strengths.size(); ++m) {
    const double share = shares[from + static_cast<Eigen::Index>(m)];
    result.start[strengths[m]] = share * proposal.tried[strengths[m]];
  }
  return result;
}

/// Signatures of all proposals side by side, with their products.
struct AllSignatures {
  std::vector<Eigen::Index> begin;  // by proposal, and the end
  Eigen::MatrixXd gram;
  Eigen::VectorXd against, low, high;
};

SUREFOOT_ONCE AllSignatures all_signatures(const std::vector<Proposal>& proposals) {
  AllSignatures all{{0}, {}, {}, {}, {}};
  Eigen::Index rows = 0;
  for (const Proposal& one : proposals) {
    all.begin.push_back(all.begin.back() + one.beyond.cols());
    rows = std::max(rows, one.beyond.rows());
  }
  const Eigen::Index count = all.begin.back();
  Eigen::MatrixXd columns(rows, count);
  all.against.resize(count);
  all.low.resize(count);
  all.high.resize(count);
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    const Proposal& one = proposals[i];
    const Eigen::Index at = all.begin[i];
    std::copy_n(one.beyond.data(), one.beyond.size(), columns.data() + at * rows);
    std::copy_n(one.along.data(), one.along.size(), all.against.data() + at);
    std::copy_n(one.least_share.data(), one.least_share.size(), all.low.data() + at);
    std::copy_n(one.most_share.data(), one.most_share.size(), all.high.data() + at);
  }
  all.gram = surefoot::detail::transposed_product(columns, columns);
  return all;
}

SUREFOOT_INLINE Shares shares_of_pair(const AllSignatures& all, std::size_t i, std::size_t j) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index k = all.begin[i]; k < all.begin[i + 1]; ++k) places.push_back(k);
  for (Eigen::Index k = all.begin[j]; k < all.begin[j + 1]; ++k) places.push_back(k);
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd gram(count, count);
  Eigen::VectorXd against(count), low(count), high(count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const Eigen::Index at = places[static_cast<std::size_t>(m)];
    against[m] = all.against[at];
    low[m] = all.low[at];
    high[m] = all.high[at];
    for (Eigen::Index n = 0; n < count; ++n) gram(m, n) = all.gram(at, places[static_cast<std::size_t>(n)]);
  }
  return best_shares(gram, against, low, high);
}

SUREFOOT_ONCE std::vector<ProposedPair> propose_pairs(const std::vector<Proposal>& proposals, std::size_t count) {
  struct Ranked {
    std::size_t first, second;
    Shares shares;
  };
  const AllSignatures all = all_signatures(proposals);
  std::vector<Ranked> ranked;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    for (std::size_t j = i + 1; j < proposals.size(); ++j) {
      const bool both = proposals[i].beyond.cols() > 0 && proposals[j].beyond.cols() > 0;
      if (!both || same_but_for_form(proposals[i].effect, proposals[j].effect)) continue;
      Shares shares = shares_of_pair(all, i, j);
      if (!std::isfinite(shares.gain) || !all_finite(shares.value)) continue;  // a signature that runs away
      ranked.push_back({i, j, std::move(shares)});
    }
  }
  sort_items(ranked, [](const Ranked& a, const Ranked& b) { return a.shares.gain > b.shares.gain; });
  std::vector<ProposedPair> pairs;
  for (const auto& [first, second, shares] : ranked) {
    if (pairs.size() == count) break;
    const Proposal &a = proposals[first], &b = proposals[second];
    const bool in_other_forms = holds_for_any(pairs, [&](const ProposedPair& other) {
      const AttachedEffect &c = other.first.effect, &d = other.second.effect;
      return (same_but_for_form(a.effect, c) && same_but_for_form(b.effect, d)) ||
             (same_but_for_form(a.effect, d) && same_but_for_form(b.effect, c));
    });
    if (in_other_forms) continue;
    pairs.push_back({started(a, shares.value, 0), started(b, shares.value, a.beyond.cols()), shares.gain});
  }
  return pairs;
}

/// Below, at or above 0 as the name and form of an effect stand before, at or after those of another.
SUREFOOT_ONCE int compare_effects(const Proposal& a, const Proposal& b) {
  const int by_name = a.effect.effect->name.compare(b.effect.effect->name);
  return by_name != 0 ? by_name : a.effect.effect->form.compare(b.effect.effect->form);
}

SUREFOOT_ONCE std::vector<ProposedPair> propose_tied_pairs(const std::vector<Proposal>& proposals, std::size_t count) {
  const std::vector<std::size_t> order = sorted_places(proposals.size(), [&](std::size_t a, std::size_t b) {
    const int before = compare_effects(proposals[a], proposals[b]);
    return before != 0 ? before < 0 : a < b;
  });
  std::vector<ProposedPair> tied;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    std::vector<Proposal> places;  // of one effect in one form
    for (; end < order.size() && compare_effects(proposals[order[begin]], proposals[order[end]]) == 0; ++end) {
      places.push_back(proposals[order[end]]);
    }
    for (ProposedPair& pair : propose_pairs(places, places.size() * places.size())) tied.push_back(std::move(pair));
  }
  sort_items(tied, [](const ProposedPair& a, const ProposedPair& b) { return a.gain > b.gain; });
  if (tied.size() > count) tied.resize(count);
  return tied;
}

}  // namespace surefoot::diagnosis
