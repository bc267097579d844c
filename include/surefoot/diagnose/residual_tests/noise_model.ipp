// Definitions of surefoot/diagnose/residual_tests/noise_model.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/residual_tests/noise_model.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Eigen::VectorXd log_likelihoods(const ResidualNoise& model, const NoiseSeries& series) {
  Eigen::VectorXd result(series.value.size());
  const double root = std::sqrt(model.share);
  double mean = 0, variance = 1, last_gap = -1, kept = 0;  // of the correlated part
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (i > 0) {
      const double gap = series.time[i] - series.time[i - 1];
      if (std::abs(gap - last_gap) > 1e-6 * gap) {
        kept = model.time > 0 ? std::exp(-gap / model.time) : 0;
        last_gap = gap;
      }
      mean *= kept;
      variance = 1 - kept * kept * (1 - variance);
    }
    const double grown = model.growth * series.speed[i];
    const double size = model.rest * model.rest + grown * grown;
    const double expected = model.share * variance + 1 - model.share;
    const double off = series.value[i] / std::sqrt(size) - root * mean;
    result[i] = -0.5 * (std::log(2 * 3.14159265358979 * size * expected) + off * off / expected);
    const double gain = root * variance / expected;
    mean += gain * off;
    variance -= gain * root * variance;
  }
  return result;
}

SUREFOOT_INLINE double total_log_likelihood(const ResidualNoise& model, const std::vector<NoiseSeries>& series) {
  double sum = 0;
  for (const NoiseSeries& one : series) sum += log_likelihoods(model, one).sum();
  return std::isfinite(sum) ? sum : -std::numeric_limits<double>::max();
}

SUREFOOT_ONCE double climb(const NoiseCoordinates& coordinates, const std::vector<NoiseSeries>& series,
                           Eigen::VectorXd& z, double width, double least) {
  double most = total_log_likelihood(coordinates.model(z), series);
  const auto try_at = [&](const Eigen::VectorXd& next) {
    const double now = total_log_likelihood(coordinates.model(next), series);
    if (now <= most) return false;
    most = now;
    z = next;
    return true;
  };
  for (; width > least; width *= 0.5) {
    for (int round = 0; round < 4; ++round) {
      const Eigen::VectorXd before = z;
      for (Eigen::Index k = 0; k < z.size(); ++k) {
        const Eigen::VectorXd here = z;
        const auto moved = [&](double by) {
          Eigen::VectorXd next = here;
          next[k] += by;
          return next;
        };
        if (!try_at(moved(width))) try_at(moved(-width));
      }
      if (std::equal(z.begin(), z.end(), before.begin())) break;
      Eigen::VectorXd beyond = z;
      for (Eigen::Index k = 0; k < z.size(); ++k) beyond[k] = 2 * z[k] - before[k];
      try_at(beyond);  // coordinates hang together
    }
  }
  return most;
}

SUREFOOT_ONCE Eigen::MatrixXd inverse_of_small(Eigen::MatrixXd a) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd result = surefoot::detail::identity(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {  // a = P L U, in place; the same exchanges of rows in the result
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    if (a(pivot, k) != 0) {
      for (Eigen::Index j = 0; j < n && pivot != k; ++j) {
        std::swap(a(k, j), a(pivot, j));
        std::swap(result(k, j), result(pivot, j));
      }
      for (Eigen::Index i = k + 1; i < n; ++i) a(i, k) /= a(k, k);
    }
    for (Eigen::Index j = k + 1; j < n; ++j) {
      for (Eigen::Index i = k + 1; i < n; ++i) a(i, j) -= a(i, k) * a(k, j);
    }
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) {
      for (Eigen::Index i = k + 1; i < n; ++i) result(i, j) -= result(k, j) * a(i, k);
    }
    for (Eigen::Index k = n - 1; k >= 0; --k) {
      result(k, j) *= 1 / a(k, k);
      for (Eigen::Index i = 0; i < k; ++i) result(i, j) -= result(k, j) * a(i, k);
    }
  }
  return result;
}

SUREFOOT_ONCE NoiseFit fit_noise(const std::vector<NoiseSeries>& series, ResidualNoiseShape shape) {
  const NoiseCoordinates coordinates(shape, series);
  NoiseFit best{.shape = shape};
  if (!(coordinates.count() > 0)) return best;
  Eigen::VectorXd at;
  for (const double rows : {1.0, 30.0}) {
    if (shape.memory == NoiseMemory::none && rows > 1) continue;
    Eigen::VectorXd z = coordinates.start(rows);
    const double most = climb(coordinates, series, z, 1, 0.01);
    if (most <= best.log_likelihood) continue;
    best.log_likelihood = most;
    at = z;
  }
  best.model = best.low = best.high = coordinates.model(at);

  // Intervals from the curvature there.
  const Eigen::Index n = at.size();
  Eigen::MatrixXd curvature(n, n);
  constexpr double h = 0.05;
  const auto shifted = [&](Eigen::Index i, double a, Eigen::Index j, double b) {
    Eigen::VectorXd z = at;
    z[i] += a;
    z[j] += b;
    return total_log_likelihood(coordinates.model(z), series);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      curvature(i, j) = curvature(j, i) =
          i == j ? -(shifted(i, h, j, 0) - 2 * best.log_likelihood + shifted(i, -h, j, 0)) / (h * h)
                 : -(shifted(i, h, j, h) - shifted(i, h, j, -h) - shifted(i, -h, j, h) + shifted(i, -h, j, -h)) /
                       (4 * h * h);
    }
  }
  const Eigen::MatrixXd covariance = inverse_of_small(curvature);
  const auto half = [](double variance) { return 1.96 * std::sqrt(std::clamp(variance, 0.0, 4.0)); };
  const auto around = [&](double ResidualNoise::*number, double width) {
    best.low.*number = best.model.*number * std::exp(-width);
    best.high.*number = best.model.*number * std::exp(width);
  };
  around(&ResidualNoise::rest, half(covariance(0, 0)));
  if (shape.grows) around(&ResidualNoise::growth, half(covariance(0, 0) + covariance(1, 1) + 2 * covariance(0, 1)));
  const Eigen::Index k = shape.grows ? 2 : 1;
  if (shape.memory != NoiseMemory::none) around(&ResidualNoise::time, half(covariance(k, k)));
  if (shape.memory == NoiseMemory::fading_and_white) {
    Eigen::VectorXd z = at;
    z[k + 1] = at[k + 1] - half(covariance(k + 1, k + 1));
    best.low.share = coordinates.model(z).share;
    z[k + 1] = at[k + 1] + half(covariance(k + 1, k + 1));
    best.high.share = coordinates.model(z).share;
  }
  return best;
}

SUREFOOT_ONCE ResidualNoise refit_noise(const std::vector<NoiseSeries>& series, const NoiseFit& near) {
  const NoiseCoordinates coordinates(near.shape, series);
  if (!(coordinates.count() > 0)) return near.model;
  Eigen::VectorXd z = coordinates.at(near.model);
  climb(coordinates, series, z, 0.2, 0.02);
  return coordinates.model(z);
}

}  // namespace surefoot::diagnosis
