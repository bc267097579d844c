// Detects that something is left: residuals of a good model are noise, which forgets itself within a few rows; what a
// model leaves out does not.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/score.hpp"

namespace surefoot {

/// How much of the residuals of one output is not noise.
struct Structure {
  double share = 0;    // of the mean square that is still correlated after the noise has forgotten itself
  double p_value = 1;  // one-sided, that there is none
  double rms = 0;      // of the residuals, in the unit of the output
};

namespace detail {

/// Residuals of one output in one recording; what was not measured is 0.
inline Eigen::VectorXd series_of(const Rig& rig, std::size_t r, const SimulatedRun& trajectory, Eigen::Index output) {
  const std::vector<Cell> cells = cells_of(rig.recordings[r]);
  const Eigen::VectorXd off = raw_residuals(rig, r, trajectory, cells);
  Eigen::VectorXd series = Eigen::VectorXd::Zero(rig.recordings[r].rows());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].output == output) series[cells[i].row] = off[static_cast<Eigen::Index>(i)];
  }
  return series;
}

/// Sums of products of neighbours `lag` rows apart, by lag, over all series.
inline Eigen::VectorXd lagged_products(const std::vector<Eigen::VectorXd>& series, Eigen::Index from, Eigen::Index to) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(to - from + 1);
  for (const Eigen::VectorXd& one : series) {
    for (Eigen::Index lag = from; lag <= std::min(to, one.size() - 1); ++lag) {
      sums[lag - from] += one.head(one.size() - lag).dot(one.tail(one.size() - lag));
    }
  }
  return sums;
}

/// Upper tail of a sum of squares with this mean and variance, as a scaled chi-square (Wilson & Hilferty 1931).
inline double chi_square_tail(double value, double mean, double variance) {
  if (!(mean > 0) || !(variance > 0)) return 1;
  const double spread = variance / (9 * mean * mean);  // 2 / (9 k), for k = 2 mean^2 / variance degrees of freedom
  return normal_tail((std::cbrt(value / mean) - (1 - spread)) / std::sqrt(spread));
}

}  // namespace detail

/// Squared correlations of residuals over all lags of `from` to `to` rows (a portmanteau, after Box & Pierce 1970), so
/// that slow errors and oscillations count alike. What noise alone would give is found by turning the signs of chunks
/// of `from` rows at random, which keeps noise as it is if it forgets itself within that many. Wild single samples are
/// cut off. Cost: 40 * rows * lags.
inline Structure residual_structure(const Rig& rig, const std::vector<std::size_t>& recordings,
                                    const std::vector<SimulatedRun>& trajectories, Eigen::Index output,
                                    Eigen::Index from, Eigen::Index to) {
  constexpr int draws = 40;
  Structure result;
  std::vector<Eigen::VectorXd> all;
  double sum = 0, count = 0;
  Eigen::Index longest = 0;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    all.push_back(detail::series_of(rig, recordings[i], trajectories[i], output));
    longest = std::max(longest, all.back().size());
    for (const double value : all.back()) {
      if (value == 0 || !std::isfinite(value)) continue;
      sum += value * value;
      ++count;
    }
  }
  if (count < 1) return result;
  result.rms = std::sqrt(sum / count);
  to = std::min(to, longest / 4);
  if (to < from || longest < 6 * from) return result;
  double squares = 0;
  for (Eigen::VectorXd& series : all) {
    series = series.unaryExpr(
        [&](double v) { return std::isfinite(v) ? std::clamp(v, -5 * result.rms, 5 * result.rms) : 0.0; });
    squares += series.squaredNorm();
  }
  if (!(squares > 0)) return result;
  const Eigen::VectorXd correlation = detail::lagged_products(all, from, to) / squares;
  Rng rng(1);
  double mean = 0, variance = 0;
  std::vector<double> nulls;
  std::vector<Eigen::VectorXd> turned = all;
  for (int draw = 0; draw < draws; ++draw) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (Eigen::Index row = 0; row < all[i].size(); row += from) {
        const Eigen::Index length = std::min(from, all[i].size() - row);
        turned[i].segment(row, length) = all[i].segment(row, length) * (rng.uniform() < 0.5 ? -1.0 : 1.0);
      }
    }
    nulls.push_back((detail::lagged_products(turned, from, to) / squares).squaredNorm());
    mean += nulls.back() / draws;
  }
  for (const double null : nulls) variance += (null - mean) * (null - mean) / (draws - 1);
  result.p_value = detail::chi_square_tail(correlation.squaredNorm(), mean, variance);
  const double excess = std::max(0.0, correlation.squaredNorm() - mean) / static_cast<double>(correlation.size());
  result.share = std::min(std::sqrt(2 * excess), correlation.cwiseAbs().maxCoeff());  // of a sine: half its square
  return result;
}

/// Standard deviation of noise that differs from row to row, from third differences of what was measured (they remove
/// motion that is smooth over four rows); noise that is correlated from row to row is underestimated.
inline double fast_noise(const Rig& rig, const std::vector<std::size_t>& recordings, Eigen::Index output) {
  std::vector<double> third;
  for (const std::size_t r : recordings) {
    const auto y = rig.recordings[r].outputs.row(output);
    for (Eigen::Index i = 0; i + 3 < y.size(); ++i) {
      const double d = y[i + 3] - 3 * y[i + 2] + 3 * y[i + 1] - y[i];
      if (std::isfinite(d)) third.push_back(std::abs(d));
    }
  }
  if (third.size() < 20) return 0;
  const auto middle = third.begin() + static_cast<std::ptrdiff_t>(third.size() / 2);
  std::nth_element(third.begin(), middle, third.end());
  return *middle / 0.6745 / std::sqrt(20.0);
}

/// Standard deviation of the noise of one output: as stated, or as far as it is fast.
inline double noise_of(const Rig& rig, const std::vector<std::size_t>& recordings, Eigen::Index output) {
  const double stated = rig.info.outputs[static_cast<std::size_t>(output)].noise;
  return stated > 0 ? stated : fast_noise(rig, recordings, output);
}

}  // namespace surefoot
