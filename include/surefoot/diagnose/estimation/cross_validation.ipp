// Definitions of surefoot/diagnose/estimation/cross_validation.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/items.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE void append_losses(BlockLosses& losses, const Eigen::VectorXd& residuals, double robust) {
  constexpr double diverged = 1e6;  // loss of a cell whose simulation ran away: much, but not everything
  const Eigen::Index cells = residuals.size(), blocks = blocks_of(cells);
  for (Eigen::Index b = 0; b < blocks; ++b) {
    const Eigen::Index from = cells * b / blocks, to = cells * (b + 1) / blocks;
    Eigen::VectorXd part(to - from);
    std::copy_n(residuals.data() + from, part.size(), part.data());
    double loss = mean_loss(part, robust) * static_cast<double>(part.size());
    if (!std::isfinite(loss)) loss = diverged * static_cast<double>(part.size());
    losses.blocks.push_back(loss);
    losses.counts.push_back(static_cast<double>(part.size()));
  }
  losses.ends.push_back(losses.blocks.size());
}

SUREFOOT_ONCE BlockLosses block_losses(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                       const std::vector<SimulatedRun>& runs, const Weighting& weighting) {
  BlockLosses result;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::size_t r = recordings[i];
    append_losses(result, weighted_residuals(bound, r, runs[i], cells_of(bound.recordings[r]), weighting),
                  weighting.robust);
  }
  return result;
}

SUREFOOT_ONCE double t_value(const std::vector<double>& differences) {
  constexpr double largest = 1e3;  // of differences that are all alike
  const auto n = static_cast<double>(differences.size());
  if (n < 2) return 0;
  double mean = 0, squares = 0;
  for (const double d : differences) mean += d / n;
  for (const double d : differences) squares += (d - mean) * (d - mean);
  const double deviation = std::sqrt(squares / (n - 1) / n);
  return deviation > 0 ? std::clamp(mean / deviation, -largest, largest)
                       : (mean > 0   ? largest
                          : mean < 0 ? -largest
                                     : 0);
}

SUREFOOT_ONCE void test_losses(const std::vector<double>& before, const std::vector<double>& after, Comparison& best) {
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

SUREFOOT_ONCE Comparison compare_losses(const BlockLosses& before, const BlockLosses& after) {
  Comparison result;
  const double a = before.total(), b = after.total();
  if (before.blocks.empty() || !(a > 0)) return result;
  result.gain = 1 - std::sqrt(b / a);
  const auto n = static_cast<double>(before.blocks.size());
  if (n < 2) return result;
  if (b < a) {
    const bool by_recording = before.ends.size() >= 6;
    test_losses(before.blocks, after.blocks, result);
    if (by_recording) test_losses(before.by_recording(), after.by_recording(), result);
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

SUREFOOT_ONCE std::vector<Hypothesis> fits_to_other_folds(const BoundSimulator& bound, const Hypothesis& start,
                                                          const FitProblem& problem,
                                                          const std::vector<std::vector<std::size_t>>& folds,
                                                          const Parallel& parallel) {
  std::vector<Hypothesis> result;
  for (const std::vector<std::size_t>& fold : folds) {
    FitProblem others = problem;
    drop_items(others.recordings, [&](std::size_t r) { return std::find(fold.begin(), fold.end(), r) != fold.end(); });
    result.push_back(
        with_grown_initial_states(bound, fit(bound, start, others, parallel).hypothesis, fold, problem, parallel));
  }
  return result;
}

}  // namespace surefoot::diagnosis
