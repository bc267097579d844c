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

/// Tail of a t test: an offset from a middle that is known as well as this sum of squares with its degrees of freedom.
SUREFOOT_ONCE double chance_beyond(double offset, double squares, double degrees) {
  if (!(squares > 0) || !(degrees > 0)) return 1;
  return t_tail(offset / std::sqrt(squares / degrees * (1 + 1 / (degrees + 1))), degrees);
}

SUREFOOT_ONCE double error_by_chance(const std::vector<double>& errors, std::size_t r) {
  constexpr double tests = 2, smallest = 1e-300;
  std::vector<double> others;
  for (std::size_t o = 0; o < errors.size(); ++o) {
    if (o != r) others.push_back(std::log(std::max(errors[o], smallest)));
  }
  const auto count = static_cast<double>(others.size());
  if (count < 2) return 1;
  const double off = std::log(std::max(errors[r], smallest)), middle = median_of(others);
  if (std::isinf(off)) return 0;
  double mean = 0, squares = 0, reach = 0, above = 0;
  for (const double other : others) {
    mean += other / count;
    squares += other * other;
    if (other <= middle) continue;
    reach += (other - middle) * (other - middle);
    ++above;
  }
  const double chance_of_scatter = chance_beyond(off - mean, std::max(squares - count * mean * mean, 0.0), count - 1);
  const double chance_of_reach = chance_beyond(off - middle, reach, above);
  return std::min(tests * std::min(chance_of_scatter, chance_of_reach), 1.0);
}

/// Mean square residual of a recording relative to how much its own outputs move: large motions are missed by more.
SUREFOOT_ONCE double relative_error(const LogFit& fit, const Recording& recording, const ResidualRows& residuals) {
  constexpr double least_motion = 0.5;  // of that of most recordings: what hardly moves is noise
  Eigen::VectorXd unit = fit.size;
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const double own = standard_deviation(surefoot::detail::row_of(recording.outputs, k));
    if (own > 0) unit[k] = std::max(own, least_motion * unit[k]);
  }
  return mean_square(residuals, unit);
}

/// Mean square errors of all recordings: of each relative to its own motion, or to that of most.
SUREFOOT_ONCE std::vector<double> errors_of(const LogFit& fit, const LogFit& like, bool relative) {
  std::vector<double> errors;
  for (std::size_t r = 0; r < fit.residuals.size(); ++r) {
    errors.push_back(relative ? relative_error(like, fit.bound.recordings[r], fit.residuals[r])
                              : mean_square(fit.residuals[r], like.size));
  }
  return errors;
}

/// The recording that is far off and further than all others, if any is.
SUREFOOT_ONCE std::optional<std::size_t> outstanding(const std::vector<double>& errors,
                                                     const LogDoctorCriteria& criteria) {
  const auto worst = static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
  const bool far_off =
      errors[worst] > criteria.decisive * worst_of_others(errors, worst) && errors[worst] > criteria.odd;
  return far_off ? std::optional(worst) : std::nullopt;
}

/// Whether a recording is further off than the scatter of the others' errors explains.
SUREFOOT_ONCE bool beyond_scatter(const std::vector<double>& errors, std::size_t r,
                                  const LogDoctorCriteria& criteria) {
  constexpr double tests = 2;  // relative to the motion of each recording and of most
  return error_by_chance(errors, r) * static_cast<double>(errors.size()) * tests < criteria.significance;
}

/// Whether it is so in single steps, where the fit is to these: noise adds up in whole recordings, so that these
/// scatter by more than steps do.
SUREFOOT_ONCE bool steps_are_beyond_scatter(const LogDoctorInputs& inputs, const LogFit& logged, std::size_t r) {
  return logged.bound.integration.restart > 0 &&
         beyond_scatter(predicted_without(inputs, logged, r).error, r, inputs.criteria);
}

/// Squared correlation of what was measured with what is simulated, as far as it is positive, of the output where it
/// is largest.
SUREFOOT_ONCE double alikeness(const Recording& recording, const ResidualRows& residuals) {
  double most = 0;
  for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (Eigen::Index row = 0; row < residuals.cols(); ++row) {
      const double measured = recording.outputs(k, row), simulated = measured + residuals(k, row);
      if (!std::isfinite(simulated)) continue;
      n += 1, x += measured, y += simulated;
      xx += measured * measured, yy += simulated * simulated, xy += measured * simulated;
    }
    const double across = n * xy - x * y, own = (n * xx - x * x) * (n * yy - y * y);
    if (across > 0 && own > 0) most = std::max(most, across * across / own);
  }
  return most;
}

/// Simulates all recordings anew.
SUREFOOT_ONCE void simulate_again(const LogDoctorInputs& inputs, LogFit& fit) {
  const LogFit before = fit;
  inputs.parallel(fit.error.size(), [&](std::size_t r) {
    Resimulation one = resimulate(before, r, before.bound.recordings[r]);
    fit.runs[r] = std::move(one.run);
    fit.residuals[r] = std::move(one.residuals);
  });
  summarize_residuals(fit);
}

/// A fit to single steps as it simulates whole recordings: noise of the steps hides what recordings differ in.
SUREFOOT_ONCE LogFit over_whole_recordings(const LogDoctorInputs& inputs, LogFit fit) {
  if (fit.bound.integration.restart == 0) return fit;
  fit.bound.integration.restart = 0;
  fit.size = output_sizes(fit.bound);
  simulate_again(inputs, fit);
  return fit;
}

/// Whether the model, whatever its parameters, scales and signs, says nothing like what a recording holds: its readings
/// do not belong to its inputs, which no missing physics brings about.
SUREFOOT_ONCE bool is_unrelated(const LogDoctorInputs& inputs, const LogFit& fit, const LogFit& predicted,
                                std::size_t r) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  const Recording& recording = fit.bound.recordings[r];
  if (recording.rows() < static_cast<Eigen::Index>(criteria.fewest_rows)) return false;
  if (alikeness(recording, predicted.residuals[r]) > 1 - criteria.odd) return false;
  const LogFit own = over_whole_recordings(inputs, fit_log(inputs, {recording}, predicted.hypothesis.parameters));
  const double left = relative_error(fit, own.bound.recordings.front(), own.residuals.front());
  return left > criteria.poor_fit && alikeness(recording, own.residuals.front()) < 1 - criteria.poor_fit;
}

SUREFOOT_ONCE LogFit predicted_without(const LogDoctorInputs& inputs, const LogFit& fit, std::size_t r) {
  std::vector<Recording> others = fit.bound.recordings;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(r));
  LogFit all = fit;
  all.hypothesis.parameters = fit_log(inputs, others, fit.hypothesis.parameters).hypothesis.parameters;
  simulate_again(inputs, all);
  return all;
}

/// How many times as far off a recording is as the worst of the others.
SUREFOOT_ONCE double times_the_others(const std::vector<double>& errors, std::size_t r) {
  return std::sqrt(errors[r] / worst_of_others(errors, r));
}

/// A recording that the model explains as well as the others, but only with parameters of its own: another payload.
/// Physics that it alone shows would rarely be a matter of parameters.
SUREFOOT_ONCE std::optional<OddRecording> with_own_parameters(const LogDoctorInputs& inputs, const LogFit& fit) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  const auto r = static_cast<std::size_t>(std::max_element(fit.error.begin(), fit.error.end()) - fit.error.begin());
  const Recording& recording = fit.bound.recordings[r];
  if (fit.noise != NoiseKind::measurement || recording.rows() < static_cast<Eigen::Index>(criteria.fewest_rows) ||
      !(times_the_others(fit.error, r) > criteria.far_off)) {
    return std::nullopt;
  }
  const LogFit predicted = predicted_without(inputs, fit, r);
  if (ran_away(predicted.error[r], criteria)) return std::nullopt;
  const double times = times_the_others(predicted.error, r);
  if (!(times > criteria.far_off) || !beyond_scatter(predicted.error, r, criteria)) return std::nullopt;
  const LogFit own = fit_log(inputs, {recording}, predicted.hypothesis.parameters);
  std::vector<double> errors = predicted.error;
  errors[r] = mean_square(own.residuals.front(), fit.size);
  if (!(times_the_others(errors, r) < std::sqrt(criteria.decisive))) return std::nullopt;
  return OddRecording{r, times};
}

SUREFOOT_ONCE std::optional<OddRecording> find_odd_recording(const LogDoctorInputs& inputs, const LogFit& logged) {
  constexpr std::size_t fewest = 4;  // recordings, to say what most of them are like
  if (logged.error.size() < fewest) return std::nullopt;
  const LogFit fit = over_whole_recordings(inputs, logged);
  for (const bool relative : {false, true}) {
    const auto odd = outstanding(errors_of(fit, fit, relative), inputs.criteria);
    if (!odd) continue;
    const LogFit predicted = predicted_without(inputs, fit, *odd);
    if (ran_away(predicted.error[*odd], inputs.criteria)) continue;
    const std::vector<double> errors = errors_of(predicted, fit, relative);
    if (outstanding(errors, inputs.criteria) != odd) continue;
    if (!beyond_scatter(errors, *odd, inputs.criteria) && !steps_are_beyond_scatter(inputs, logged, *odd) &&
        !is_unrelated(inputs, fit, predicted, *odd)) {
      continue;
    }
    return OddRecording{*odd, times_the_others(errors, *odd)};
  }
  return with_own_parameters(inputs, logged);
}

}  // namespace surefoot::diagnosis
