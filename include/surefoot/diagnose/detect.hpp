// Detects that something is left: residuals of a good model are noise, which forgets itself within a few rows; what a
// model leaves out does not.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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

}  // namespace detail

/// Correlation of residuals over lags of `from` to `to` rows, tested over blocks. Wild single samples are cut off.
inline Structure residual_structure(const Rig& rig, const std::vector<std::size_t>& recordings,
                                    const std::vector<SimulatedRun>& trajectories, Eigen::Index output,
                                    Eigen::Index from, Eigen::Index to) {
  Structure result;
  std::vector<Eigen::VectorXd> all;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    all.push_back(detail::series_of(rig, recordings[i], trajectories[i], output));
    for (const double value : all.back()) {
      if (value == 0 || !std::isfinite(value)) continue;
      sum += value * value;
      ++count;
    }
  }
  if (count < 1) return result;
  result.rms = std::sqrt(sum / count);
  std::vector<double> blocks;
  double squares = 0;
  for (Eigen::VectorXd& series : all) {
    series = series.unaryExpr(
        [&](double v) { return std::isfinite(v) ? std::clamp(v, -5 * result.rms, 5 * result.rms) : 0.0; });
    if (series.size() < 4 * to) continue;
    const Eigen::Index parts = std::clamp<Eigen::Index>(series.size() / (5 * to), 1, 8);
    for (Eigen::Index part = 0; part < parts; ++part) {
      const Eigen::Index a = series.size() * part / parts, b = series.size() * (part + 1) / parts;
      double product = 0;
      for (Eigen::Index lag = from; lag <= to; ++lag) {
        product += series.segment(a, b - a - lag).dot(series.segment(a + lag, b - a - lag)) *
                   static_cast<double>(b - a) / static_cast<double>(b - a - lag);
      }
      blocks.push_back(product / static_cast<double>(to - from + 1));
      squares += series.segment(a, b - a).squaredNorm();
    }
  }
  if (blocks.size() < 3 || !(squares > 0)) return result;
  double mean = 0, spread = 0;
  for (const double block : blocks) mean += block / static_cast<double>(blocks.size());
  for (const double block : blocks) spread += (block - mean) * (block - mean);
  const auto n = static_cast<double>(blocks.size());
  const double deviation = std::sqrt(spread / (n - 1) / n);
  result.share = std::max(0.0, mean * n / squares);
  result.p_value = deviation > 0 ? normal_tail(mean / deviation) : 1;
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

}  // namespace surefoot
