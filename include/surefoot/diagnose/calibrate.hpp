// Calibrates the nominal parameters and the unknown initial states: a wrong parameter is not missing physics.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/fit.hpp"

namespace surefoot {

/// Standard deviation of each output over some recordings.
inline Eigen::VectorXd output_spreads(const Rig& rig, const std::vector<std::size_t>& recordings) {
  Eigen::VectorXd spreads(static_cast<Eigen::Index>(rig.info.outputs.size()));
  for (Eigen::Index k = 0; k < spreads.size(); ++k) {
    double sum = 0, squares = 0, count = 0;
    for (const std::size_t r : recordings) {
      for (const double value : rig.recordings[r].outputs.row(k)) {
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

/// The same hypothesis from other parameters of the simulator: Latin-hypercube points over their bounds.
inline std::vector<Hypothesis> scattered(const Rig& rig, const Hypothesis& around, std::size_t points,
                                         std::uint64_t seed) {
  std::vector<Variable> variables = variables_of(rig, around, {});
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

/// `best`, or a clearly better fit from one of the two best such points around a hypothesis.
inline Fit scattered_fit(const Rig& rig, Fit best, const Hypothesis& around, const FitProblem& problem,
                         std::size_t points, std::uint64_t seed, const Parallel& parallel) {
  const std::vector<Hypothesis> starts = scattered(rig, around, points, seed);
  std::vector<double> losses(starts.size());
  parallel(starts.size(), [&](std::size_t k) {
    const detail::FitFunctions functions(rig, starts[k], problem, serially());
    const Eigen::VectorXd residuals = functions.residuals(functions.start());
    losses[k] = residuals.allFinite() ? mean_loss(residuals, problem.weighting.robust)
                                      : std::numeric_limits<double>::infinity();
  });
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return losses[a] < losses[b]; });
  std::vector<Fit> fits(std::min<std::size_t>(2, order.size()));
  parallel(fits.size(), [&](std::size_t k) { fits[k] = fit(rig, starts[order[k]], problem, serially()); });
  for (const Fit& other : fits) {
    if (other.ok && other.loss < 0.98 * best.loss) best = other;
  }
  return best;
}

namespace detail {

/// By recording: square root of the root mean square residual in units of sigma. Recordings that a model misses by far
/// then count more than others, but do not silence them.
inline std::vector<double> recording_scales(const Rig& rig, const FitProblem& problem,
                                            const std::vector<SimulatedRun>& trajectories) {
  std::vector<double> scales(rig.recordings.size(), 1.0);
  Weighting plain = problem.weighting;
  plain.scale.clear();
  for (std::size_t i = 0; i < problem.recordings.size(); ++i) {
    const std::size_t r = problem.recordings[i];
    const Eigen::VectorXd off = weighed_residuals(rig, r, trajectories[i], cells_of(rig.recordings[r]), plain);
    if (off.size() == 0 || !off.allFinite()) continue;
    scales[r] = std::sqrt(std::clamp(std::sqrt(mean_loss(off, plain.robust)), 1e-3, 1e3));
  }
  return scales;
}

}  // namespace detail

/// Global start: Latin-hypercube points over the bounds beside the nominal one; the best few are fitted, the best of
/// those kept. Then twice more with each output and each recording weighed by what is left of it.
inline Fit calibrate(const Rig& rig, const Hypothesis& nominal, FitProblem& problem, std::size_t points,
                     std::uint64_t seed, const Parallel& parallel) {
  problem.weighting.sigma = output_spreads(rig, problem.recordings);
  Eigen::VectorXd floor = problem.weighting.sigma * 1e-6;
  for (Eigen::Index k = 0; k < floor.size(); ++k) {
    const double noise = rig.info.outputs[static_cast<std::size_t>(k)].noise;
    if (noise > 0) floor[k] = noise;
  }
  FitProblem first = problem;
  first.max_iterations = 20;
  Fit best = fit(rig, nominal, first, parallel);

  best = scattered_fit(rig, best, nominal, first, points, seed, parallel);
  if (!best.ok) {
    throw DiagnoseError(
        "the model cannot be simulated over the recordings with any parameters that were tried: check "
        "its equations, initial values and bounds");
  }
  for (int round = 0; round < 2; ++round) {
    const auto trajectories = simulate_all(rig, best.hypothesis, problem.recordings, problem.integration, parallel);
    problem.weighting.sigma = residual_sizes(rig, problem.recordings, trajectories).cwiseMax(floor);
    problem.weighting.scale = detail::recording_scales(rig, problem, trajectories);
    best = fit(rig, best.hypothesis, problem, parallel);
  }
  return best;
}

/// The cheapest integration whose error is small against what is left of each output (5 %), tried on one recording.
inline Integration choose_integration(const Rig& rig, const Hypothesis& hypothesis, const Eigen::VectorXd& left,
                                      const Integration& now, std::size_t recording) {
  if (rig.info.kind == SimulatorKind::map) return now;
  const Recording& example = rig.recordings[recording];
  std::vector<double> intervals;
  for (Eigen::Index i = 1; i < example.rows(); ++i) intervals.push_back(example.time[i] - example.time[i - 1]);
  std::nth_element(intervals.begin(), intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2),
                   intervals.end());
  const double row = intervals[intervals.size() / 2];
  Integration fine = now;
  fine.order = 4;
  fine.step = row / 8;
  const SimulatedRun exact = simulate(rig, hypothesis, recording, fine);
  if (!exact.finite) return fine;
  for (const auto& [order, step] : {std::pair{2, 1.5 * row}, {4, 1.5 * row}, {4, row / 1.9}, {4, row / 3.9}}) {
    Integration coarse = now;
    coarse.order = order;
    coarse.step = step;
    const SimulatedRun trajectory = simulate(rig, hypothesis, recording, coarse);
    if (!trajectory.finite) continue;
    bool good = true;
    for (Eigen::Index k = 0; k < left.size(); ++k) {
      const double error = detail::root_mean_square(trajectory.outputs.row(k) - exact.outputs.row(k));
      good = good && error < 0.05 * left[k];
    }
    if (good) return coarse;
  }
  return fine;
}

namespace detail {

/// Rates from each row to the next [1/s, or per step]; none for less than two rows.
inline Eigen::MatrixXd row_rates(const Eigen::VectorXd& time, const Eigen::MatrixXd& states) {
  const Eigen::Index intervals = std::max<Eigen::Index>(0, states.cols() - 1);
  const Eigen::VectorXd steps = time.tail(intervals) - time.head(intervals);
  const Eigen::MatrixXd changes = states.rightCols(intervals) - states.leftCols(intervals);
  return changes * steps.cwiseInverse().asDiagonal();
}

}  // namespace detail

/// Typical sizes of everything along the trajectories of a hypothesis.
inline Sizes measure_sizes(const Rig& rig, const Hypothesis& hypothesis, const std::vector<std::size_t>& recordings,
                           const std::vector<SimulatedRun>& trajectories) {
  Sizes sizes = rig.sizes;
  const auto n = rig.info.states.size(), m = rig.info.inputs.size(), s = rig.info.signals.size();
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
    intervals += static_cast<double>(rig.recordings[r].rows() - 1);
    duration += rig.recordings[r].duration();
  }
  sizes.time = intervals > 0 && duration > 0 ? 200 * duration / intervals : 1;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Recording& recording = rig.recordings[recordings[i]];
    const Eigen::MatrixXd& states = trajectories[i].states;
    if (!trajectories[i].finite) continue;
    Eigen::MatrixXd efforts, signals;
    rig.probe(rig, recordings[i], hypothesis.parameters, states, efforts, signals);
    const auto weight = static_cast<double>(recording.rows());
    rows += weight;
    const auto add = [&](std::vector<double>& sums, const Eigen::MatrixXd& values, bool about_mean) {
      for (std::size_t k = 0; k < sums.size(); ++k) {
        const auto line = values.row(static_cast<Eigen::Index>(k));
        const double size = about_mean ? detail::spread(line) : detail::root_mean_square(line);
        sums[k] += weight * size * size;
      }
    };
    add(state, states, false);
    add(position, states, true);
    add(rate, detail::row_rates(recording.time, states), false);
    add(effort, efforts, rig.info.kind == SimulatorKind::map);
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
  const Eigen::VectorXd spreads = output_spreads(rig, recordings);
  for (Eigen::Index k = 0; k < spreads.size(); ++k) sizes.output[static_cast<std::size_t>(k)] = spreads[k];
  return sizes;
}

}  // namespace surefoot
