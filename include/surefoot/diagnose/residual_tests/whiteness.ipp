// Definitions of surefoot/diagnose/residual_tests/whiteness.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Eigen::VectorXd series_of(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                                        Eigen::Index output) {
  const std::vector<Cell> cells = cells_of(bound.recordings[r]);
  const Eigen::VectorXd off = raw_residuals(bound, r, trajectory, cells);
  Eigen::VectorXd series = Eigen::VectorXd::Zero(bound.recordings[r].rows());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].output == output) series[cells[i].row] = off[static_cast<Eigen::Index>(i)];
  }
  return series;
}

SUREFOOT_INLINE Eigen::VectorXd lagged_products(const std::vector<Eigen::VectorXd>& series, Eigen::Index from,
                                                Eigen::Index to) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(to - from + 1);
  for (const Eigen::VectorXd& one : series) {
    for (Eigen::Index lag = from; lag <= std::min(to, one.size() - 1); ++lag) {
      sums[lag - from] += surefoot::detail::dot(one.data(), one.data() + lag, one.size() - lag);
    }
  }
  return sums;
}

SUREFOOT_ONCE double predicted_share(const std::vector<Eigen::VectorXd>& series, Eigen::Index gap) {
  constexpr double ridge = 1e-6;       // of the mean square: residuals without noise predict themselves
  const Eigen::Index known = 4 * gap;  // rows that predict
  const Eigen::VectorXd products = lagged_products(series, 0, gap + known);
  if (!(products[0] > 0)) return 0;
  Eigen::MatrixXd among(known, known);
  Eigen::VectorXd ahead(known);
  for (Eigen::Index i = 0; i < known; ++i) {
    for (Eigen::Index j = 0; j < known; ++j) among(i, j) = products[std::abs(i - j)] / products[0];
    among(i, i) += ridge;
    ahead[i] = products[gap + i] / products[0];
  }
  const Eigen::VectorXd weights = surefoot::detail::solve_symmetric(among, ahead);
  return std::clamp(surefoot::detail::dot(weights.data(), ahead.data(), known), 0.0, 1.0);
}

SUREFOOT_ONCE double chi_square_score(double value, double mean, double variance) {
  const double relative = variance / (9 * mean * mean);  // 2 / (9 k), for k = 2 mean^2 / variance degrees of freedom
  return (std::cbrt(value / mean) - (1 - relative)) / std::sqrt(relative);
}

SUREFOOT_ONCE double chi_square_tail(double value, double mean, double variance) {
  if (!(mean > 0) || !(variance > 0)) return 1;
  return normal_tail(chi_square_score(value, mean, variance));
}

/// Sum of the squares of what was measured, and its count.
SUREFOOT_INLINE std::pair<double, double> squares_of(const Eigen::VectorXd& series) {
  double sum = 0, count = 0;
  for (const double value : series) {
    if (value == 0 || !std::isfinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return {sum, count};
}

SUREFOOT_ONCE WhitenessTest test_whiteness(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                           const std::vector<SimulatedRun>& trajectories, Eigen::Index output,
                                           Eigen::Index from, Eigen::Index to) {
  constexpr int draws = 40;
  WhitenessTest result;
  std::vector<Eigen::VectorXd> all;
  std::vector<double> each;  // mean squares of recordings
  double sum = 0, count = 0;
  Eigen::Index longest = 0;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    all.push_back(series_of(bound, recordings[i], trajectories[i], output));
    longest = std::max(longest, all.back().size());
    const auto [squares, measured] = squares_of(all.back());
    if (measured > 0) each.push_back(squares / measured);
    sum += squares;
    count += measured;
  }
  if (count < 1) return result;
  result.rms = std::sqrt(sum / count);
  const auto middle = each.begin() + static_cast<std::ptrdiff_t>(each.size() / 2);
  std::nth_element(each.begin(), middle, each.end());
  result.typical = std::sqrt(*middle);
  to = std::min(to, longest / 4);
  if (to < from || longest < 6 * from) return result;
  double squares = 0;
  for (Eigen::VectorXd& series : all) {
    for (double& value : series) {
      value = std::isfinite(value) ? std::clamp(value, -5 * result.rms, 5 * result.rms) : 0.0;
    }
    squares += surefoot::detail::sum_of_squares(series);
  }
  if (!(squares > 0)) return result;
  Eigen::VectorXd correlation = lagged_products(all, from, to);
  correlation /= squares;
  Rng rng(1);
  double mean = 0, variance = 0;
  std::vector<double> nulls;
  std::vector<Eigen::VectorXd> turned = all;
  for (int draw = 0; draw < draws; ++draw) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (Eigen::Index row = 0; row < all[i].size(); row += from) {
        const Eigen::Index length = std::min(from, all[i].size() - row);
        const double sign = rng.uniform() < 0.5 ? -1.0 : 1.0;
        for (Eigen::Index k = row; k < row + length; ++k) turned[i][k] = all[i][k] * sign;
      }
    }
    Eigen::VectorXd null = lagged_products(turned, from, to);
    null /= squares;
    nulls.push_back(surefoot::detail::sum_of_squares(null));
    mean += nulls.back() / draws;
  }
  for (const double null : nulls) variance += (null - mean) * (null - mean) / (draws - 1);
  const double correlated = surefoot::detail::sum_of_squares(correlation);
  result.p_value = chi_square_tail(correlated, mean, variance);
  const double excess = std::max(0.0, correlated - mean) / static_cast<double>(correlation.size());
  double largest = 0;
  for (const double value : correlation) largest = std::max(largest, std::abs(value));
  result.share = std::min(std::sqrt(2 * excess), largest);  // of a sine: half its square
  result.predicted = predicted_share(all, from);
  return result;
}

}  // namespace surefoot::diagnosis
