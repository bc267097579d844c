// Definitions of surefoot/motion/changes/noise_change.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/motion/changes/noise_change.hpp"

namespace surefoot {

namespace detail {

/// Logarithm of the density of the logarithm of an F-distributed number, up to a constant.
SUREFOOT_INLINE double log_f_density(double log_value, double above, double below) {
  return 0.5 * above * log_value - 0.5 * (above + below) * std::log1p(above / below * std::exp(log_value));
}

SUREFOOT_INLINE double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

}  // namespace detail

SUREFOOT_INLINE VarianceEstimate pooled_variance(const Eigen::VectorXd& mean_squares, double usual) {
  constexpr double weight = 2;  // of the usual degrees of freedom [sequences]
  const auto count = static_cast<double>(mean_squares.size());
  const double mean = mean_squares.mean();
  if (!(mean > 0) || count < 1) return {.variance = mean, .freedoms = std::max(1.0, count * usual)};
  const double squares = (mean_squares.array() / mean - 1).square().sum();
  const double relative = (squares + weight * 2 / usual) / (std::max(0.0, count - 1) + weight);  // variance
  return {.variance = mean, .freedoms = count * 2 / std::max(relative, 2 / usual)};
}

SUREFOOT_INLINE VarianceChange variance_change(const VarianceEstimate& before, const VarianceEstimate& after,
                                               double deviation) {
  if (!(before.variance > 0 && after.variance > 0 && deviation > 0)) {
    throw MotionError("variance_change: variances and their deviation must be above 0");
  }
  constexpr int points = 801;  // of the integral over the logarithm of the ratio
  constexpr double range = 8;  // [deviations] that it goes over, to either side of 0
  const double seen = std::log(after.variance / before.variance);
  const auto log_density = [&](double log_ratio) {
    return detail::log_f_density(seen - log_ratio, after.freedoms, before.freedoms);
  };
  VarianceChange result{.ratio = std::exp(seen)};
  const double none = log_density(0), likeliest = detail::log_f_density(0, after.freedoms, before.freedoms);
  result.log_likelihood_ratio = likeliest - none;
  const double step = 2 * range * deviation / (points - 1);
  double with_prior = 0, all = 0;
  std::vector<double> cumulated;
  for (int i = 0; i < points; ++i) {
    const double x = -range * deviation + step * i, density = std::exp(log_density(x) - likeliest);
    const double u = x / deviation;
    with_prior += density * std::exp(-0.5 * u * u) * step / (deviation * std::sqrt(2 * std::numbers::pi));
    cumulated.push_back(all += density);
  }
  result.log_bayes_factor = std::log(std::max(with_prior, 1e-300)) + likeliest - none;
  const auto quantile = [&](double share) {
    const auto at = std::lower_bound(cumulated.begin(), cumulated.end(), share * all) - cumulated.begin();
    return std::exp(-range * deviation + step * static_cast<double>(at));
  };
  result.low = quantile(0.025);
  result.high = quantile(0.975);
  return result;
}

SUREFOOT_INLINE FallChange fall_change(const FallCount& before, const FallCount& after) {
  const auto valid = [](const FallCount& c) { return c.fell >= 0 && c.sequences >= 1 && c.fell <= c.sequences; };
  if (!valid(before) || !valid(after)) throw MotionError("fall_change: no more can fall than walked, at least one did");
  const double a = before.fell, b = after.fell, n = before.sequences, m = after.sequences;
  const int fell = before.fell + after.fell;
  FallChange result;
  result.log_bayes_factor = detail::log_beta(a + 1, n - a + 1) + detail::log_beta(b + 1, m - b + 1) -
                            detail::log_beta(a + b + 1, n + m - a - b + 1);
  const auto log_choose = [](double k, double of) {
    return std::lgamma(of + 1) - std::lgamma(k + 1) - std::lgamma(of - k + 1);
  };
  const auto log_probability = [&](int of_before) {  // hypergeometric
    return log_choose(of_before, n) + log_choose(fell - of_before, m) - log_choose(fell, n + m);
  };
  constexpr double equal = 1e-7;  // probabilities closer than this count as the same
  double sum = 0;
  for (int i = std::max(0, fell - after.sequences); i <= std::min(fell, before.sequences); ++i) {
    if (log_probability(i) <= log_probability(before.fell) + equal) sum += std::exp(log_probability(i));
  }
  result.p_value = std::min(1.0, sum);
  return result;
}

}  // namespace surefoot
