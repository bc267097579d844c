// How well hypotheses do, block by block, so that two of them can be compared in pairs.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/fit.hpp"

namespace surefoot {

/// Robust squared residuals summed over blocks of the recordings; the blocks are the same for every hypothesis.
struct Score {
  std::vector<double> blocks = {}, counts = {};
  std::vector<std::size_t> ends = {};  // by recording: of its blocks

  double total() const {
    double sum = 0;
    for (const double block : blocks) sum += block;
    return sum;
  }
  double cells() const {
    double sum = 0;
    for (const double count : counts) sum += count;
    return sum;
  }
  std::vector<double> by_recording() const {
    std::vector<double> sums(ends.size(), 0.0);
    for (std::size_t r = 0; r < ends.size(); ++r) {
      for (std::size_t b = r == 0 ? 0 : ends[r - 1]; b < ends[r]; ++b) sums[r] += blocks[b];
    }
    return sums;
  }
  void append(const Score& other) {
    for (const std::size_t end : other.ends) ends.push_back(blocks.size() + end);
    blocks.insert(blocks.end(), other.blocks.begin(), other.blocks.end());
    counts.insert(counts.end(), other.counts.begin(), other.counts.end());
  }
  /// Root mean square in units of the weighting.
  double rms() const { return cells() > 0 ? std::sqrt(total() / cells()) : 0; }
};

/// Splits a recording's residuals into at most eight blocks, each long enough to be nearly independent of the others.
inline Eigen::Index blocks_of(Eigen::Index cells) { return std::clamp<Eigen::Index>(cells / 60, 1, 8); }

inline void add_to_score(Score& score, const Eigen::VectorXd& residuals, double robust) {
  const Eigen::Index cells = residuals.size(), blocks = blocks_of(cells);
  for (Eigen::Index b = 0; b < blocks; ++b) {
    const Eigen::Index from = cells * b / blocks, to = cells * (b + 1) / blocks;
    const Eigen::VectorXd part = residuals.segment(from, to - from);
    double loss = mean_loss(part, robust) * static_cast<double>(part.size());
    if (!std::isfinite(loss)) loss = 1e6 * static_cast<double>(part.size());
    score.blocks.push_back(loss);
    score.counts.push_back(static_cast<double>(part.size()));
  }
  score.ends.push_back(score.blocks.size());
}

/// Score of a hypothesis as it is, on some recordings.
inline Score score(const Rig& rig, const Hypothesis& hypothesis, const std::vector<std::size_t>& recordings,
                   const Weighting& weighting, const Integration& integration, const Parallel& parallel) {
  std::vector<Eigen::VectorXd> residuals(recordings.size());
  parallel(recordings.size(), [&](std::size_t i) {
    const std::size_t r = recordings[i];
    residuals[i] =
        weighed_residuals(rig, r, simulate(rig, hypothesis, r, integration), cells_of(rig.recordings[r]), weighting);
  });
  Score result;
  for (const Eigen::VectorXd& one : residuals) add_to_score(result, one, weighting.robust);
  return result;
}

/// How much better `after` is than `before`.
struct Comparison {
  double gain = 0;     // share of the root mean square error that goes: 1 - after / before
  double stderr_ = 0;  // of it, over blocks
  double t = 0;        // gain of the loss over its standard error
  double p_value = 1;  // one-sided
};

/// Upper tail of the standard normal distribution.
inline double normal_tail(double t) { return 0.5 * std::erfc(t / std::sqrt(2.0)); }

/// One-sided p-value of Student's t with `dof` degrees of freedom, by its normal score (Wallace 1959).
inline double student_tail(double t, double dof) {
  if (dof < 1) return 1;
  return normal_tail(std::copysign(std::sqrt(dof * std::log1p(t * t / dof)) * (8 * dof + 1) / (8 * dof + 3), t));
}

/// Student's t of the mean of some differences.
inline double t_value(const std::vector<double>& differences) {
  const auto n = static_cast<double>(differences.size());
  if (n < 2) return 0;
  double mean = 0, squares = 0;
  for (const double d : differences) mean += d / n;
  for (const double d : differences) squares += (d - mean) * (d - mean);
  const double deviation = std::sqrt(squares / (n - 1) / n);
  return deviation > 0 ? std::clamp(mean / deviation, -1e3, 1e3) : (mean > 0 ? 1e3 : mean < 0 ? -1e3 : 0);
}

namespace detail {

/// One more way to test the differences between two lists of losses; the best one counts.
inline void test_losses(const std::vector<double>& before, const std::vector<double>& after, Comparison& best) {
  std::vector<double> absolute, relative;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double d = before[i] - after[i], sum = before[i] + after[i];
    absolute.push_back(d);
    relative.push_back(sum > 0 ? d / sum : 0);
  }
  const auto dof = static_cast<double>(before.size()) - 1;
  for (const double t : {t_value(absolute), t_value(relative)}) {
    const double p = student_tail(t, dof);
    if (p >= best.p_value) continue;
    best.p_value = p;
    best.t = t;
  }
}

}  // namespace detail

/// Paired over blocks, and over whole recordings where there are at least six: by the losses themselves, and by their
/// relative differences (a - b) / (a + b), which a few with large losses cannot decide. The best counts, and pays for
/// the choice.
inline Comparison compare_scores(const Score& before, const Score& after) {
  Comparison result;
  const double a = before.total(), b = after.total();
  if (before.blocks.empty() || !(a > 0)) return result;
  result.gain = 1 - std::sqrt(b / a);
  const auto n = static_cast<double>(before.blocks.size());
  if (n < 2) return result;
  if (b < a) {
    const bool by_recording = before.ends.size() >= 6;
    detail::test_losses(before.blocks, after.blocks, result);
    if (by_recording) detail::test_losses(before.by_recording(), after.by_recording(), result);
    result.p_value = std::min(1.0, (by_recording ? 4 : 2) * result.p_value);
  } else {
    std::vector<double> differences;
    for (std::size_t i = 0; i < before.blocks.size(); ++i) differences.push_back(before.blocks[i] - after.blocks[i]);
    result.t = t_value(differences);
  }
  double squares = 0;  // of the ratio b / a, which the gain is the root of
  for (std::size_t i = 0; i < before.blocks.size(); ++i) {
    const double off = after.blocks[i] - b / a * before.blocks[i];
    squares += off * off;
  }
  result.stderr_ = std::sqrt(n / (n - 1) * squares) / a / (2 * std::sqrt(std::max(b / a, 1e-12)));
  return result;
}

/// Held-out score: each fold is judged by a fit to the other folds, which starts from `start`. Blocks come in the order
/// of the folds.
struct CrossValidation {
  Score score;
  std::vector<Hypothesis> folds;
};

inline CrossValidation cross_validate(const Rig& rig, const Hypothesis& start, const FitProblem& problem,
                                      const std::vector<std::vector<std::size_t>>& folds, const Parallel& parallel) {
  CrossValidation result;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    FitProblem others = problem;
    others.recordings.clear();
    for (std::size_t j = 0; j < folds.size(); ++j) {
      if (j != k) others.recordings.insert(others.recordings.end(), folds[j].begin(), folds[j].end());
    }
    const Hypothesis fitted =
        with_estimated_starts(rig, fit(rig, start, others, parallel).hypothesis, folds[k], problem, parallel);
    const Score one = score(rig, fitted, folds[k], problem.weighting, problem.integration, parallel);
    result.score.append(one);
    result.folds.push_back(fitted);
  }
  return result;
}

}  // namespace surefoot
