// Definitions of surefoot/diagnose/log_doctor/odd_recording.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/log_doctor/odd_recording.hpp"
#include "surefoot/diagnose/log_doctor/tails.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Probability that the logarithm of an error lies so far from those of the others by chance (a t test).
SUREFOOT_INLINE double error_by_chance(const std::vector<double>& errors, std::size_t r) {
  double mean = 0, squares = 0, count = 0;
  for (std::size_t o = 0; o < errors.size(); ++o) {
    if (o == r) continue;
    const double logarithm = std::log(std::max(errors[o], 1e-300));
    mean += logarithm;
    squares += logarithm * logarithm;
    ++count;
  }
  if (count < 2) return 1;
  mean /= count;
  const double variance = std::max(squares / count - mean * mean, 0.0) * count / (count - 1) * (1 + 1 / count);
  const double off = std::log(std::max(errors[r], 1e-300)) - mean;
  if (std::isinf(off)) return 0;
  return variance > 0 ? t_tail(off / std::sqrt(variance), count - 1) : 1;
}

/// Mean square residual of a recording relative to how much its own outputs move: large motions are missed by more.
SUREFOOT_INLINE double relative_error(const LogFit& fit, const Recording& recording, const ResidualRows& residuals) {
  constexpr double least_motion = 0.5;  // of that of most recordings: what hardly moves is noise
  Eigen::VectorXd unit = fit.size;
  for (Eigen::Index k = 0; k < unit.size() && fit.bound.integration.restart == 0; ++k) {
    const double own = standard_deviation(surefoot::detail::row_of(recording.outputs, k));
    if (own > 0) unit[k] = std::max(own, least_motion * unit[k]);
  }
  return mean_square(residuals, unit);
}

SUREFOOT_INLINE std::optional<OddRecording> find_odd_recording(const LogDoctorInputs& inputs, const LogFit& fit) {
  constexpr std::size_t fewest = 4;  // recordings, to say what most of them are like
  const std::size_t count = fit.error.size();
  if (count < fewest) return std::nullopt;
  std::vector<double> relative;
  for (std::size_t r = 0; r < count; ++r) {
    relative.push_back(relative_error(fit, fit.bound.recordings[r], fit.residuals[r]));
  }
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(relative) - relative.begin());
  const auto is_odd = [&](const std::vector<double>& errors) {
    double others = 0;
    for (std::size_t o = 0; o < count; ++o) others = std::max(others, o == worst ? 0 : errors[o]);
    const double chance = error_by_chance(errors, worst) * static_cast<double>(count);
    const bool far_off = errors[worst] > inputs.criteria.decisive * others && errors[worst] > inputs.criteria.odd;
    return far_off && chance < inputs.criteria.significance;
  };
  if (!is_odd(relative)) return std::nullopt;
  std::vector<Recording> others = fit.bound.recordings;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(worst));
  const LogFit without = fit_log(inputs, others, fit.hypothesis.parameters);
  LogFit all = fit;  // with the parameters of the others
  all.hypothesis.parameters = without.hypothesis.parameters;
  std::vector<double> errors = without.error;
  const Recording& left_out = fit.bound.recordings[worst];
  const double predicted = relative_error(fit, left_out, resimulate(all, worst, left_out).residuals);
  for (std::size_t o = 0; o < errors.size(); ++o) {  // in the same units
    errors[o] = relative_error(fit, others[o], without.residuals[o]);
  }
  errors.insert(errors.begin() + static_cast<std::ptrdiff_t>(worst), predicted);
  if (!is_odd(errors)) return std::nullopt;
  double next = 0;
  for (std::size_t o = 0; o < count; ++o) next = std::max(next, o == worst ? 0 : errors[o]);
  return OddRecording{worst, std::sqrt(predicted / next)};
}

}  // namespace surefoot::diagnosis
