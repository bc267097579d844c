// A model of noise: its size may grow with speed, and it may be correlated from row to row.
//
//   r = s e,   s^2 = rest^2 + (growth v)^2,   e = sqrt(share) x + sqrt(1 - share) w
//
// with w white and x of correlation exp(-dt / time) (Ornstein & Uhlenbeck 1930), so that rows may be missing or
// unevenly spaced; both of variance 1. Gaussian likelihood by a Kalman filter of one state: O(samples).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace surefoot {

/// Residuals of one output in one recording, where it was measured.
struct NoiseSeries {
  Eigen::VectorXd time;   // [s], or rows
  Eigen::VectorXd value;  // in the unit of the output
  Eigen::VectorXd speed;  // of the output, per second or row
};

/// What is left of a sample in the next one: nothing, some, or some beside white noise.
enum class NoiseMemory : std::uint8_t { none, fading, fading_and_white };

struct ResidualNoiseShape {
  NoiseMemory memory = NoiseMemory::none;
  bool grows = false;  // with speed

  int numbers() const { return 1 + static_cast<int>(memory) + (grows ? 1 : 0); }
};

struct ResidualNoise {
  double rest = 1;    // standard deviation at rest
  double growth = 0;  // of the standard deviation with speed [s, or rows]
  double time = 0;    // of correlation [s, or rows]; 0: white
  double share = 0;   // of the variance that is correlated
};

/// Logarithm of the probability density of each sample, given those before it.
inline Eigen::VectorXd log_likelihoods(const ResidualNoise& model, const NoiseSeries& series) {
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

/// A maximum of the likelihood.
struct NoiseFit {
  ResidualNoise model = {};
  ResidualNoiseShape shape = {};
  double log_likelihood = -std::numeric_limits<double>::infinity();
  ResidualNoise low = {}, high = {};  // ends of the 95 % intervals
};

namespace detail {

/// The numbers of a noise model as coordinates without bounds: logarithms of rest, growth and time, logit of the share.
class NoiseCoordinates {
 public:
  NoiseCoordinates(ResidualNoiseShape shape, const std::vector<NoiseSeries>& series) : shape_(shape) {
    std::vector<double> gaps;
    double values = 0, speeds = 0;
    for (const NoiseSeries& one : series) {
      for (Eigen::Index i = 1; i < one.time.size(); ++i) gaps.push_back(one.time[i] - one.time[i - 1]);
      values += one.value.squaredNorm();
      speeds += one.speed.squaredNorm();
      count_ += static_cast<double>(one.value.size());
    }
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    if (!gaps.empty()) row_ = *middle;
    if (values > 0) size_ = std::sqrt(values / count_);
    if (speeds > 0) speed_ = std::sqrt(speeds / count_);
  }

  double count() const { return count_; }
  double row() const { return row_; }

  ResidualNoise model(const Eigen::VectorXd& z) const {
    ResidualNoise model;
    model.rest = size_ * std::exp(std::clamp(z[0], -12.0, 3.0));
    Eigen::Index k = 1;
    if (shape_.grows) model.growth = model.rest / speed_ * std::exp(std::clamp(z[k++], -5.0, 5.0));
    if (shape_.memory == NoiseMemory::none) return model;
    model.time = row_ * std::exp(std::clamp(z[k++], -2.0, 7.0));
    model.share = shape_.memory == NoiseMemory::fading ? 1 : 1 / (1 + std::exp(-std::clamp(z[k], -6.0, 6.0)));
    return model;
  }

  /// Where a model lies that has these numbers.
  Eigen::VectorXd at(const ResidualNoise& model) const {
    Eigen::VectorXd z(shape_.numbers());
    z[0] = std::log(model.rest / size_);
    Eigen::Index k = 1;
    if (shape_.grows) z[k++] = std::log(model.growth * speed_ / model.rest);
    if (shape_.memory != NoiseMemory::none) z[k++] = std::log(model.time / row_);
    if (shape_.memory == NoiseMemory::fading_and_white) z[k] = std::log(model.share / (1 - model.share));
    return z;
  }

  /// A model of typical size that forgets itself within so many rows.
  Eigen::VectorXd start(double rows) const { return at({size_, size_ / speed_, rows * row_, 0.5}); }

 private:
  ResidualNoiseShape shape_;
  double row_ = 1, size_ = 1, speed_ = 1, count_ = 0;
};

inline double total_log_likelihood(const ResidualNoise& model, const std::vector<NoiseSeries>& series) {
  double sum = 0;
  for (const NoiseSeries& one : series) sum += log_likelihoods(model, one).sum();
  return std::isfinite(sum) ? sum : -std::numeric_limits<double>::max();
}

/// Climbs the likelihood from z on, in steps along the coordinates from `width` down to `least`.
inline double climb(const NoiseCoordinates& coordinates, const std::vector<NoiseSeries>& series, Eigen::VectorXd& z,
                    double width, double least) {
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
        const Eigen::VectorXd step = width * Eigen::VectorXd::Unit(z.size(), k);
        if (!try_at(z + step)) try_at(z - step);
      }
      if (z == before) break;
      try_at(2 * z - before);  // coordinates hang together
    }
  }
  return most;
}

}  // namespace detail

/// Maximum likelihood by a coordinate search, from short and from long correlation; some hundred passes.
inline NoiseFit fit_noise(const std::vector<NoiseSeries>& series, ResidualNoiseShape shape) {
  const detail::NoiseCoordinates coordinates(shape, series);
  NoiseFit best{.shape = shape};
  if (!(coordinates.count() > 0)) return best;
  Eigen::VectorXd at;
  for (const double rows : {1.0, 30.0}) {
    if (shape.memory == NoiseMemory::none && rows > 1) continue;
    Eigen::VectorXd z = coordinates.start(rows);
    const double most = detail::climb(coordinates, series, z, 1, 0.01);
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
    return detail::total_log_likelihood(coordinates.model(z), series);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      curvature(i, j) = curvature(j, i) =
          i == j ? -(shifted(i, h, j, 0) - 2 * best.log_likelihood + shifted(i, -h, j, 0)) / (h * h)
                 : -(shifted(i, h, j, h) - shifted(i, h, j, -h) - shifted(i, -h, j, h) + shifted(i, -h, j, -h)) /
                       (4 * h * h);
    }
  }
  const Eigen::MatrixXd covariance = curvature.inverse();
  const auto half = [](double variance) { return 1.96 * std::sqrt(std::clamp(variance, 0.0, 4.0)); };
  const auto around = [&](double ResidualNoise::* number, double width) {
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

/// The most likely model close to one of other series, in some ten passes.
inline ResidualNoise refit_noise(const std::vector<NoiseSeries>& series, const NoiseFit& near) {
  const detail::NoiseCoordinates coordinates(near.shape, series);
  if (!(coordinates.count() > 0)) return near.model;
  Eigen::VectorXd z = coordinates.at(near.model);
  detail::climb(coordinates, series, z, 0.2, 0.02);
  return coordinates.model(z);
}

}  // namespace surefoot
