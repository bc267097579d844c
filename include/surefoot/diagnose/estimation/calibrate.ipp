// Definitions of surefoot/diagnose/estimation/calibrate.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Eigen::VectorXd output_spreads(const BoundSimulator& bound,
                                               const std::vector<std::size_t>& recordings) {
  Eigen::VectorXd spreads(static_cast<Eigen::Index>(bound.info.outputs.size()));
  for (Eigen::Index k = 0; k < spreads.size(); ++k) {
    double sum = 0, squares = 0, count = 0;
    for (const std::size_t r : recordings) {
      for (const double value : bound.recordings[r].outputs.row(k)) {
        if (!std::isfinite(value)) continue;
        sum += value;
        squares += value * value;
        ++count;
      }
    }
    const double mean = count > 0 ? sum / count : 0;
    const double spread = count > 0 ? std::sqrt(std::max(0.0, squares / count - mean * mean)) : 0;
    spreads[k] = spread > 1e-12 * (1 + std::abs(mean)) ? spread : 1;
  }
  return spreads;
}

SUREFOOT_INLINE std::vector<Hypothesis> scattered(const BoundSimulator& bound, const Hypothesis& around,
                                                  std::size_t points, std::uint64_t seed) {
  std::vector<Variable> variables = variables_of(bound, around, {});
  std::erase_if(variables, [](const Variable& one) { return one.kind != Variable::Kind::parameter; });
  std::vector<Hypothesis> starts;
  if (variables.empty()) return starts;
  Rng rng(seed, 0xca1u);
  for (std::size_t k = 0; k < points; ++k) {
    Hypothesis start = around;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const double low = to_search(variables[i], variables[i].low), high = to_search(variables[i], variables[i].high);
      // one stratum per point and variable, dealt by a cyclic shift that differs between variables
      const auto cell = static_cast<double>((k * (2 * i + 1) + i) % points);
      const double share = (cell + rng.uniform()) / static_cast<double>(points);
      value_of(start, variables[i]) = from_search(variables[i], low + share * (high - low));
    }
    starts.push_back(start);
  }
  return starts;
}

SUREFOOT_INLINE Fit scattered_fit(const BoundSimulator& bound, Fit best, const Hypothesis& around,
                                  const FitProblem& problem, std::size_t points, std::uint64_t seed,
                                  const Parallel& parallel) {
  const std::vector<Hypothesis> starts = scattered(bound, around, points, seed);
  std::vector<double> losses(starts.size());
  parallel(starts.size(), [&](std::size_t k) {
    const FitFunctions functions(bound, starts[k], problem, serially());
    const Eigen::VectorXd residuals = functions.residuals(functions.start());
    losses[k] = residuals.allFinite() ? mean_loss(residuals, problem.weighting.robust)
                                      : std::numeric_limits<double>::infinity();
  });
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return losses[a] < losses[b]; });
  std::vector<Fit> fits(std::min<std::size_t>(2, order.size()));
  parallel(fits.size(), [&](std::size_t k) { fits[k] = fit(bound, starts[order[k]], problem, serially()); });
  for (const Fit& other : fits) {
    if (other.ok && other.loss < 0.98 * best.loss) best = other;
  }
  return best;
}

SUREFOOT_INLINE std::vector<double> recording_scales(const BoundSimulator& bound, const FitProblem& problem,
                                                     const std::vector<SimulatedRun>& trajectories) {
  std::vector<double> scales(bound.recordings.size(), 1.0);
  Weighting plain = problem.weighting;
  plain.scale.clear();
  for (std::size_t i = 0; i < problem.recordings.size(); ++i) {
    const std::size_t r = problem.recordings[i];
    const Eigen::VectorXd off = weighed_residuals(bound, r, trajectories[i], cells_of(bound.recordings[r]), plain);
    if (off.size() == 0 || !off.allFinite()) continue;
    scales[r] = std::sqrt(std::clamp(std::sqrt(mean_loss(off, plain.robust)), 1e-3, 1e3));
  }
  return scales;
}

SUREFOOT_INLINE Fit calibrate(const BoundSimulator& bound, const Hypothesis& nominal, FitProblem& problem,
                              std::size_t points, std::uint64_t seed, const Parallel& parallel) {
  problem.weighting.sigma = output_spreads(bound, problem.recordings);
  Eigen::VectorXd floor = problem.weighting.sigma * 1e-6;
  for (Eigen::Index k = 0; k < floor.size(); ++k) {
    const double noise = bound.info.outputs[static_cast<std::size_t>(k)].noise;
    if (noise > 0) floor[k] = noise;
  }
  FitProblem first = problem;
  first.max_iterations = 20;
  Fit best = fit(bound, nominal, first, parallel);

  best = scattered_fit(bound, best, nominal, first, points, seed, parallel);
  if (!best.ok) {
    throw DiagnoseError(
        "the model cannot be simulated over the recordings with any parameters that were tried: check "
        "its equations, initial values and bounds");
  }
  for (int round = 0; round < 2; ++round) {
    const auto trajectories = simulate_all(bound, best.hypothesis, problem.recordings, problem.integration, parallel);
    problem.weighting.sigma = residual_sizes(bound, problem.recordings, trajectories).cwiseMax(floor);
    problem.weighting.scale = recording_scales(bound, problem, trajectories);
    best = fit(bound, best.hypothesis, problem, parallel);
  }
  return best;
}

SUREFOOT_INLINE Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                               const Eigen::VectorXd& left, const Integration& now,
                                               std::size_t recording) {
  if (bound.info.kind == SimulatorKind::map) return now;
  const Recording& example = bound.recordings[recording];
  std::vector<double> intervals;
  for (Eigen::Index i = 1; i < example.rows(); ++i) intervals.push_back(example.time[i] - example.time[i - 1]);
  std::nth_element(intervals.begin(), intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2),
                   intervals.end());
  const double row = intervals[intervals.size() / 2];
  Integration fine = now;
  fine.order = 4;
  fine.step = row / 8;
  const SimulatedRun exact = simulate(bound, hypothesis, recording, fine);
  if (!exact.finite) return fine;
  for (const auto& [order, step] : {std::pair{2, 1.5 * row}, {4, 1.5 * row}, {4, row / 1.9}, {4, row / 3.9}}) {
    Integration coarse = now;
    coarse.order = order;
    coarse.step = step;
    const SimulatedRun trajectory = simulate(bound, hypothesis, recording, coarse);
    if (!trajectory.finite) continue;
    bool good = true;
    for (Eigen::Index k = 0; k < left.size(); ++k) {
      const double error = root_mean_square(trajectory.outputs.row(k) - exact.outputs.row(k));
      good = good && error < 0.05 * left[k];
    }
    if (good) return coarse;
  }
  return fine;
}

SUREFOOT_INLINE Eigen::MatrixXd row_rates(const Eigen::VectorXd& time, const Eigen::MatrixXd& states) {
  const Eigen::Index intervals = std::max<Eigen::Index>(0, states.cols() - 1);
  const Eigen::VectorXd steps = time.tail(intervals) - time.head(intervals);
  const Eigen::MatrixXd changes = states.rightCols(intervals) - states.leftCols(intervals);
  return changes * steps.cwiseInverse().asDiagonal();
}

SUREFOOT_INLINE Sizes measure_sizes(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                    const std::vector<std::size_t>& recordings,
                                    const std::vector<SimulatedRun>& trajectories) {
  Sizes sizes = bound.sizes;
  const auto n = bound.info.states.size(), m = bound.info.inputs.size(), s = bound.info.signals.size();
  std::vector<double> state(n), position(n), rate(n), effort(n), input(m), signal(s);
  sizes.state_peak.assign(n, 0.0);
  sizes.input_peak.assign(m, 0.0);
  sizes.signal_peak.assign(s, 0.0);
  const auto raise = [](std::vector<double>& peaks, const Eigen::MatrixXd& values) {
    for (std::size_t k = 0; k < peaks.size(); ++k) {
      for (const double value : values.row(static_cast<Eigen::Index>(k))) {
        if (std::isfinite(value)) peaks[k] = std::max(peaks[k], std::abs(value));
      }
    }
  };
  double rows = 0, intervals = 0, duration = 0;
  for (const std::size_t r : recordings) {
    intervals += static_cast<double>(bound.recordings[r].rows() - 1);
    duration += bound.recordings[r].duration();
  }
  sizes.time = intervals > 0 && duration > 0 ? 200 * duration / intervals : 1;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Recording& recording = bound.recordings[recordings[i]];
    const Eigen::MatrixXd& states = trajectories[i].states;
    if (!trajectories[i].finite) continue;
    Eigen::MatrixXd efforts, signals;
    bound.probe(bound, recordings[i], hypothesis.parameters, states, efforts, signals);
    const auto weight = static_cast<double>(recording.rows());
    rows += weight;
    const auto add = [&](std::vector<double>& sums, const Eigen::MatrixXd& values, bool about_mean) {
      for (std::size_t k = 0; k < sums.size(); ++k) {
        const auto line = values.row(static_cast<Eigen::Index>(k));
        const double size = about_mean ? spread(line) : root_mean_square(line);
        sums[k] += weight * size * size;
      }
    };
    add(state, states, false);
    add(position, states, true);
    add(rate, row_rates(recording.time, states), false);
    add(effort, efforts, bound.info.kind == SimulatorKind::map);
    add(input, recording.inputs, false);
    add(signal, signals, false);
    raise(sizes.state_peak, states);
    raise(sizes.input_peak, recording.inputs);
    raise(sizes.signal_peak, signals);
  }
  const auto finish = [&](std::vector<double>& to, const std::vector<double>& sums) {
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const double size = rows > 0 ? std::sqrt(sums[k] / rows) : 1;
      to[k] = size > 1e-9 ? size : 1;
    }
  };
  finish(sizes.state, state);
  finish(sizes.position, position);
  finish(sizes.rate, rate);
  finish(sizes.effort, effort);
  finish(sizes.input, input);
  finish(sizes.signal, signal);
  const Eigen::VectorXd spreads = output_spreads(bound, recordings);
  for (Eigen::Index k = 0; k < spreads.size(); ++k) sizes.output[static_cast<std::size_t>(k)] = spreads[k];
  return sizes;
}

}  // namespace surefoot::diagnosis
