// Definitions of surefoot/diagnose/log_doctor/odd_recording.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
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
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const double own = standard_deviation(surefoot::detail::row_of(recording.outputs, k));
    if (own > 0) unit[k] = std::max(own, least_motion * unit[k]);
  }
  return mean_square(residuals, unit);
}

/// Mean square errors of all recordings: of each relative to its own motion, or to that of most.
SUREFOOT_INLINE std::vector<double> errors_of(const LogFit& fit, const LogFit& like, bool relative) {
  std::vector<double> errors;
  for (std::size_t r = 0; r < fit.residuals.size(); ++r) {
    const bool own = relative && like.bound.integration.restart == 0;
    errors.push_back(own ? relative_error(like, fit.bound.recordings[r], fit.residuals[r])
                         : mean_square(fit.residuals[r], like.size));
  }
  return errors;
}

/// The recording that stands out, if any does.
SUREFOOT_INLINE std::optional<std::size_t> outstanding(const std::vector<double>& errors,
                                                       const LogDoctorCriteria& criteria) {
  constexpr double tests = 2;  // relative to the motion of each recording and of most
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(errors) - errors.begin());
  double others = 0;
  for (std::size_t o = 0; o < errors.size(); ++o) others = std::max(others, o == worst ? 0 : errors[o]);
  const double chance = error_by_chance(errors, worst) * static_cast<double>(errors.size()) * tests;
  const bool far_off = errors[worst] > criteria.decisive * others && errors[worst] > criteria.odd;
  return far_off && chance < criteria.significance ? std::optional(worst) : std::nullopt;
}

/// What a calibration without recording r predicts of all.
SUREFOOT_INLINE LogFit predicted_without(const LogDoctorInputs& inputs, const LogFit& fit, std::size_t r) {
  std::vector<Recording> others = fit.bound.recordings;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(r));
  LogFit without = fit_log(inputs, others, fit.hypothesis.parameters);
  LogFit all = fit;
  all.hypothesis.parameters = without.hypothesis.parameters;
  ResidualRows left_out = resimulate(all, r, fit.bound.recordings[r]).residuals;
  all.residuals = std::move(without.residuals);
  all.residuals.insert(all.residuals.begin() + static_cast<std::ptrdiff_t>(r), std::move(left_out));
  return all;
}

SUREFOOT_INLINE std::optional<OddRecording> find_odd_recording(const LogDoctorInputs& inputs, const LogFit& fit) {
  constexpr std::size_t fewest = 4;  // recordings, to say what most of them are like
  if (fit.error.size() < fewest) return std::nullopt;
  for (const bool relative : {false, true}) {
    const auto odd = outstanding(errors_of(fit, fit, relative), inputs.criteria);
    if (!odd) continue;
    const std::vector<double> errors = errors_of(predicted_without(inputs, fit, *odd), fit, relative);
    if (outstanding(errors, inputs.criteria) != odd) continue;
    double next = 0;
    for (std::size_t o = 0; o < errors.size(); ++o) next = std::max(next, o == *odd ? 0 : errors[o]);
    return OddRecording{*odd, std::sqrt(errors[*odd] / next)};
  }
  return std::nullopt;
}

}  // namespace surefoot::diagnosis
