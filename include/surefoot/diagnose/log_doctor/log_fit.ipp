// Definitions of surefoot/diagnose/log_doctor/log_fit.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/log_doctor/log_fit.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  const double below = *std::max_element(values.begin(), middle);
  return below == *middle ? below : below + (*middle - below) / 2;  // infinite values too
}

SUREFOOT_ONCE double worst_of_others(const std::vector<double>& errors, std::size_t r) {
  double worst = 0;
  for (std::size_t o = 0; o < errors.size(); ++o) worst = std::max(worst, o == r ? 0 : errors[o]);
  return worst;
}

SUREFOOT_ONCE double mean_square(const ResidualRows& residuals, const Eigen::VectorXd& unit) {
  double sum = 0, count = 0;
  for (Eigen::Index row = 0; row < residuals.cols(); ++row) {
    for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
      const double off = residuals(k, row) / unit[k];
      if (std::isnan(off)) continue;
      sum += off * off;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

SUREFOOT_ONCE bool ran_away(double error, const LogDoctorCriteria& criteria) {
  return !(error < criteria.runs_away * criteria.runs_away);
}

SUREFOOT_ONCE double independent_share(const ResidualRows& residuals, const Eigen::VectorXd& unit) {
  double squares = 0, products = 0, count = 0;
  for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
    double before = std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index row = 0; row < residuals.cols(); ++row) {
      const double off = residuals(k, row) / unit[k];
      if (!std::isfinite(off)) continue;
      squares += off * off;
      ++count;
      if (std::isfinite(before)) products += off * before;
      before = off;
    }
  }
  if (!(squares > 0)) return 1;
  const double r = std::clamp(products / squares, 0.0, 1.0);
  return std::max((1 - r * r) / (1 + r * r), 1 / std::max(count, 1.0));
}

/// The bound simulator with one recording alone, in another version.
SUREFOOT_ONCE BoundSimulator with_version(const BoundSimulator& bound, std::size_t r, const Recording& version) {
  BoundSimulator one = without_functions(bound.info, bound.structure, {version});  // its own full turns
  one.sizes = bound.sizes;
  one.integration = bound.integration;
  one.simulate = bound.simulate;
  one.recordings.resize(r + 1);
  std::swap(one.recordings[0], one.recordings[r]);
  return one;
}

SUREFOOT_ONCE ResidualRows residual_rows(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run) {
  const Recording& recording = bound.recordings[r];
  ResidualRows rows = ResidualRows::Constant(recording.outputs.rows(), recording.outputs.cols(),
                                             std::numeric_limits<double>::quiet_NaN());
  const std::vector<Cell> cells = cells_of(recording);
  const Eigen::VectorXd off = raw_residuals(bound, r, run, cells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rows(cells[i].output, cells[i].row) = off[static_cast<Eigen::Index>(i)];
  }
  return rows;
}

SUREFOOT_ONCE Resimulation resimulate(const LogFit& fit, std::size_t r, const Recording& version) {
  const BoundSimulator one = with_version(fit.bound, r, version);
  Hypothesis hypothesis = fit.hypothesis;
  hypothesis.initial[r] = version.initial;
  if (has_unknown_initial_state(version)) {
    FitProblem problem;
    problem.recordings = {r};
    problem.weighting.sigma = fit.typical;
    problem.integration = one.integration;
    problem.max_iterations = LogDoctorCriteria{}.fit_iterations;
    hypothesis = with_estimated_initial_states(one, hypothesis, {r}, problem, serially());
  }
  Resimulation result;
  result.run = simulate(one, hypothesis, r, one.integration);
  result.residuals = residual_rows(one, r, result.run);
  return result;
}

SUREFOOT_ONCE Eigen::VectorXd output_sizes(const BoundSimulator& bound) {
  constexpr double smallest = 1e-12;  // in place of 0, so that a size may be divided by
  const bool steps = bound.integration.restart > 0;
  Eigen::VectorXd sizes(static_cast<Eigen::Index>(bound.info.outputs.size()));
  for (Eigen::Index k = 0; k < sizes.size(); ++k) {
    std::vector<double> of_recordings, all;
    for (const Recording& recording : bound.recordings) {
      Eigen::VectorXd y = surefoot::detail::row_of(recording.outputs, k);
      if (steps) {
        for (Eigen::Index row = y.size() - 1; row > 0; --row) y[row] -= y[row - 1];
        y[0] = std::numeric_limits<double>::quiet_NaN();
      }
      for (const double value : y) {
        if (std::isfinite(value)) all.push_back(value);
      }
      const double deviation = standard_deviation(y);
      if (deviation > 0) of_recordings.push_back(deviation);
    }
    double size = median_of(of_recordings);
    if (of_recordings.size() * 2 < bound.recordings.size() && !all.empty()) {  // single measurements
      size = standard_deviation(Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
    }
    sizes[k] = std::max(size, smallest);
  }
  return sizes;
}

/// Recordings of the calibration, evenly chosen.
SUREFOOT_ONCE std::vector<std::size_t> fitted_recordings(const BoundSimulator& bound,
                                                         const LogDoctorCriteria& criteria) {
  std::size_t rows = 0;
  for (const Recording& recording : bound.recordings) rows += static_cast<std::size_t>(recording.rows());
  const std::size_t count = bound.recordings.size();
  std::size_t wanted = count;
  if (rows > criteria.fit_rows) wanted = std::max(criteria.few_fitted, count * criteria.fit_rows / rows);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < std::min(wanted, count); ++i) chosen.push_back(i * count / std::min(wanted, count));
  return chosen;
}

/// By recording, the inverse of its weight: the size of what is left of it, so that one that is spoilt counts little.
SUREFOOT_ONCE std::vector<double> inverse_weights(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                  const FitProblem& problem, const Parallel& parallel) {
  constexpr double least = 1e-3, most = 1e3;  // no recording alone decides a fit
  std::vector<double> scales(bound.recordings.size(), 1.0);
  const auto runs = simulate_all(bound, hypothesis, problem.recordings, problem.integration, parallel);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t r = problem.recordings[i];
    const double square = mean_square(residual_rows(bound, r, runs[i]), problem.weighting.sigma);
    scales[r] = std::isfinite(square) ? std::clamp(std::sqrt(square), least, most) : most;
  }
  return scales;
}

SUREFOOT_ONCE void summarize_residuals(LogFit& fit) {
  constexpr double smallest = 1e-9;  // of an output's size: a perfect fit
  for (Eigen::Index k = 0; k < fit.size.size(); ++k) {
    std::vector<double> squares;
    for (const ResidualRows& residuals : fit.residuals) {
      double sum = 0, n = 0;
      for (Eigen::Index row = 0; row < residuals.cols(); ++row) {
        if (std::isnan(residuals(k, row))) continue;
        sum += residuals(k, row) * residuals(k, row);
        ++n;
      }
      if (n > 0) squares.push_back(sum / n);
    }
    const double middle = std::sqrt(median_of(squares));
    fit.typical[k] = std::isfinite(middle) ? std::max(middle, smallest * fit.size[k]) : fit.size[k];
  }
  fit.error.clear();
  for (const ResidualRows& residuals : fit.residuals) fit.error.push_back(mean_square(residuals, fit.size));
}

SUREFOOT_ONCE void measure_what_is_left(LogFit& fit, const FitProblem& problem, const Parallel& parallel) {
  const std::size_t count = fit.bound.recordings.size();
  fit.runs.resize(count);
  fit.residuals.resize(count);
  fit.typical = fit.size;
  parallel(count, [&](std::size_t r) {
    Recording version = fit.bound.recordings[r];
    const bool fitted = std::find(problem.recordings.begin(), problem.recordings.end(), r) != problem.recordings.end();
    if (fitted && has_unknown_initial_state(version)) {
      fit.runs[r] = simulate(fit.bound, fit.hypothesis, r, fit.bound.integration);
      fit.residuals[r] = residual_rows(with_version(fit.bound, r, version), r, fit.runs[r]);
    } else {
      Resimulation one = resimulate(fit, r, version);
      fit.runs[r] = std::move(one.run);
      fit.residuals[r] = std::move(one.residuals);
    }
  });
  summarize_residuals(fit);
}

SUREFOOT_ONCE LogFit fit_log(const LogDoctorInputs& inputs, std::vector<Recording> recordings,
                             const Eigen::VectorXd& parameters, std::size_t points) {
  const LogDoctorCriteria& criteria = inputs.criteria;
  LogFit result;
  result.bound = inputs.bind(std::move(recordings));
  BoundSimulator& bound = result.bound;
  result.hypothesis = inputs.nominal(bound);
  if (parameters.size() > 0) result.hypothesis.parameters = parameters;
  FitProblem problem;
  problem.recordings = fitted_recordings(bound, criteria);
  result.noise = noise_kind(bound, result.hypothesis, problem.recordings);
  bound.integration.restart = result.noise == NoiseKind::process ? 1 : 0;
  problem.integration = bound.integration;
  problem.max_iterations = criteria.fit_iterations;
  problem.stopped = inputs.stopped;
  problem.weighting.sigma = result.size = output_sizes(bound);
  Fit best{.hypothesis = result.hypothesis};
  for (int round = 0; round < criteria.fit_rounds; ++round) {
    problem.weighting.scale = inverse_weights(bound, best.hypothesis, problem, inputs.parallel);
    best = fit(bound, best.hypothesis, problem, inputs.parallel);
    if (round == 0 && points > 0) {
      problem.weighting.scale.clear();
      best = fit(bound, best.hypothesis, problem, inputs.parallel);
      if (!best.ok) best.loss = std::numeric_limits<double>::infinity();
      best = scattered_fit(bound, best, best.hypothesis, problem, points, 1, inputs.parallel);
    }
    if (!best.ok) break;
  }
  result.hypothesis = best.hypothesis;
  measure_what_is_left(result, problem, inputs.parallel);
  return result;
}

}  // namespace surefoot::diagnosis
