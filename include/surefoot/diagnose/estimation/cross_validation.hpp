// Comparison of hypotheses, block by block and in pairs, and fits that have not seen a fold.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// In place of a divisor that may be 0: a ratio then is large, but finite.
inline constexpr double never_zero = 1e-300;

/// Robust squared residuals summed over blocks of the recordings; the blocks are the same for every hypothesis.
struct BlockLosses {
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
  /// Root mean square in units of the weighting.
  double rms() const { return cells() > 0 ? std::sqrt(total() / cells()) : 0; }
};

/// Splits a recording's residuals into at most eight blocks, each long enough to be nearly independent of the others.
inline Eigen::Index blocks_of(Eigen::Index cells) { return std::clamp<Eigen::Index>(cells / 60, 1, 8); }

void append_losses(BlockLosses& losses, const Eigen::VectorXd& residuals, double robust);

/// Losses of simulations, which go with the recordings.
BlockLosses block_losses(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                         const std::vector<SimulatedRun>& runs, const Weighting& weighting);

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
double t_value(const std::vector<double>& differences);

/// One more way to test the differences between two lists of losses; the best one counts.
void test_losses(const std::vector<double>& before, const std::vector<double>& after, Comparison& best);

/// Paired over blocks, and over whole recordings where there are at least six: by the losses themselves, and by their
/// relative differences (a - b) / (a + b), which a few with large losses cannot decide. The best counts, and pays for
/// the choice.
Comparison compare_losses(const BlockLosses& before, const BlockLosses& after);

/// By fold, a fit to the recordings of the problem that are not in it, from `start` on; the unknown initial states of
/// the fold are estimated with all else as it is.
std::vector<Hypothesis> fits_to_other_folds(const BoundSimulator& bound, const Hypothesis& start,
                                            const FitProblem& problem,
                                            const std::vector<std::vector<std::size_t>>& folds,
                                            const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/cross_validation.ipp"
#endif
