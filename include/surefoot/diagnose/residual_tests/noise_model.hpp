// Model of noise: its size may grow with speed, and it may be correlated from row to row.
//
//   r = s e,   s^2 = rest^2 + (growth v)^2,   e = sqrt(share) x + sqrt(1 - share) w
//
// with w white and x of correlation exp(-dt / time) (Ornstein & Uhlenbeck 1930), so that rows may be missing or
// unevenly spaced; both of variance 1. Gaussian likelihood by a Kalman filter of one state: O(samples).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

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
Eigen::VectorXd log_likelihoods(const ResidualNoise& model, const NoiseSeries& series);

/// A maximum of the likelihood.
struct NoiseFit {
  ResidualNoise model = {};
  ResidualNoiseShape shape = {};
  double log_likelihood = -std::numeric_limits<double>::infinity();
  ResidualNoise low = {}, high = {};  // ends of the 95 % intervals
};

/// The numbers of a noise model as coordinates without bounds: logarithms of rest, growth and time, logit of the share.
class NoiseCoordinates {
 public:
  NoiseCoordinates(ResidualNoiseShape shape, const std::vector<NoiseSeries>& series) : shape_(shape) {
    std::vector<double> gaps;
    double values = 0, speeds = 0;
    for (const NoiseSeries& one : series) {
      for (Eigen::Index i = 1; i < one.time.size(); ++i) gaps.push_back(one.time[i] - one.time[i - 1]);
      values += surefoot::detail::sum_of_squares(one.value);
      speeds += surefoot::detail::sum_of_squares(one.speed);
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

double total_log_likelihood(const ResidualNoise& model, const std::vector<NoiseSeries>& series);

/// Climbs the likelihood from z on, in steps along the coordinates from `width` down to `least`.
double climb(const NoiseCoordinates& coordinates, const std::vector<NoiseSeries>& series, Eigen::VectorXd& z,
             double width, double least);

/// By elimination with row pivots, O(n^3): for matrices of a few rows.
Eigen::MatrixXd inverse_of_small(Eigen::MatrixXd a);

/// Maximum likelihood by a coordinate search, from short and from long correlation; some hundred passes.
NoiseFit fit_noise(const std::vector<NoiseSeries>& series, ResidualNoiseShape shape);

/// The most likely model close to one of other series, in some ten passes.
ResidualNoise refit_noise(const std::vector<NoiseSeries>& series, const NoiseFit& near);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/noise_model.ipp"
#endif
