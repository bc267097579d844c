// Definitions of surefoot/diagnose/estimation/noise_regime.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/exponentials.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Errors of an output from the second row on, about their mean; 0 where nothing was measured.
SUREFOOT_ONCE Eigen::VectorXd errors_of_steps(const BoundSimulator& bound, std::size_t r,
                                              const SimulatedRun& trajectory, Eigen::Index output) {
  const Eigen::MatrixXd& measured = bound.recordings[r].outputs;
  const bool wrapped = bound.wrapped[static_cast<std::size_t>(output)];
  Eigen::VectorXd off(measured.cols() - 1);
  for (Eigen::Index i = 0; i < off.size(); ++i) {
    const double value = trajectory.outputs(output, i + 1) - measured(output, i + 1);
    off[i] = wrapped ? wrap_angle(value) : value;
    if (!std::isfinite(off[i])) off[i] = 0;
  }
  const double mean = off.mean();
  for (double& value : off) value -= mean;
  return off;
}

SUREFOOT_ONCE Eigen::MatrixXd step_correlations(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                const std::vector<std::size_t>& recordings) {
  Integration stepwise = bound.integration;
  stepwise.restart = 1;
  const auto outputs = static_cast<Eigen::Index>(bound.info.outputs.size());
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(outputs, 3);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(outputs);
  for (const std::size_t r : recordings) {
    const SimulatedRun trajectory = simulate(bound, hypothesis, r, stepwise);
    if (!trajectory.finite || bound.recordings[r].rows() < 5) continue;
    for (Eigen::Index k = 0; k < outputs; ++k) {
      const Eigen::VectorXd off = errors_of_steps(bound, r, trajectory, k);
      for (Eigen::Index lag = 1; lag <= 3; ++lag) {
        products(k, lag - 1) += surefoot::detail::dot(off.data() + lag, off.data(), off.size() - lag);
      }
      squares[k] += surefoot::detail::sum_of_squares(off);
    }
  }
  for (Eigen::Index k = 0; k < outputs; ++k) {
    for (Eigen::Index lag = 0; lag < 3; ++lag) products(k, lag) /= std::max(squares[k], 1e-300);
  }
  return products;
}

SUREFOOT_ONCE bool only_final_pose(const BoundSimulator& bound) {
  if (!bound.info.planar) return false;
  for (const Recording& recording : bound.recordings) {
    for (Eigen::Index row = 1; row + 1 < recording.rows(); ++row) {
      for (Eigen::Index k = 0; k < recording.outputs.rows(); ++k) {
        if (std::isfinite(recording.outputs(k, row))) return false;
      }
    }
  }
  return true;
}

SUREFOOT_ONCE bool few_readings(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  constexpr std::size_t few = 20;
  std::size_t with_few = 0;
  for (const std::size_t r : recordings) with_few += cells_of(bound.recordings[r]).size() < few ? 1 : 0;
  return recordings.empty() || with_few > recordings.size() / 2;
}

/// With parameters that suit single steps best: what others are off by goes with the commands, and is no noise.
SUREFOOT_ONCE Hypothesis fitted_to_steps(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                         const std::vector<std::size_t>& recordings) {
  FitProblem steps;
  steps.recordings = recordings;
  steps.integration = bound.integration;
  steps.integration.restart = 1;
  steps.weighting.sigma = output_deviations(bound, recordings);
  steps.free = Free::all_but_effects;
  const Fit fitted = fit(bound, hypothesis, steps, serially());
  return fitted.ok ? fitted.hypothesis : hypothesis;
}

SUREFOOT_ONCE NoiseKind noise_kind(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                   const std::vector<std::size_t>& recordings) {
  if (bound.info.kind != SimulatorKind::map) return NoiseKind::measurement;
  if (only_final_pose(bound)) return NoiseKind::final_pose;
  if (!bound.structure.all_states_measured) return NoiseKind::measurement;
  const auto states_it = [](const OutputInfo& output) { return output.process_noise > 0; };
  if (holds_for_all(bound.info.outputs, states_it)) return NoiseKind::process;
  const Eigen::MatrixXd apart = step_correlations(bound, fitted_to_steps(bound, hypothesis, recordings), recordings);
  constexpr double alternating = 0.3;    // a correlation two or three rows apart: such steps differ in turn, no noise
  constexpr double differenced = -0.25;  // half way between noise of the process (0) and of measurement (-1/2)
  bool in_turn = false;
  Eigen::VectorXd next(apart.rows());
  for (Eigen::Index k = 0; k < apart.rows(); ++k) {
    next[k] = apart(k, 0);
    in_turn = in_turn || std::max(apart(k, 1), apart(k, 2)) > alternating;
  }
  return next.mean() < differenced && !in_turn ? NoiseKind::measurement : NoiseKind::process;
}

/// Adds v v^T to `sum`.
SUREFOOT_ONCE void add_outer_product(Eigen::MatrixXd& sum, const Eigen::VectorXd& v) {
  for (Eigen::Index j = 0; j < v.size(); ++j) {
    for (Eigen::Index i = 0; i < v.size(); ++i) sum(i, j) += v[i] * v[j];
  }
}

/// Residuals of a walk of which the end was measured, and how their covariance grows with each variance.
struct FinalResiduals {
  Eigen::VectorXd off;
  Eigen::MatrixXd by_position, by_heading, tape_position, tape_heading;  // covariances for unit variances
};

SUREFOOT_ONCE FinalResiduals final_residuals(const BoundSimulator& bound, std::size_t r,
                                             const SimulatedRun& trajectory) {
  const PlanarInfo& planar = *bound.info.planar;
  const std::vector<Cell> cells = cells_of(bound.recordings[r]);
  const auto count = static_cast<Eigen::Index>(cells.size());
  FinalResiduals sequence;
  sequence.off = raw_residuals(bound, r, trajectory, cells);
  sequence.by_position = Eigen::MatrixXd::Zero(count, count);
  sequence.by_heading = sequence.tape_position = sequence.tape_heading = sequence.by_position;
  const Eigen::Index last = trajectory.states.cols() - 1;
  std::vector<int> kind(cells.size(), -1);  // 0: x, 1: y, 2: heading
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto k = static_cast<int>(cells[i].output);
    if (bound.structure.output_of[static_cast<std::size_t>(planar.x)] == k) kind[i] = 0;
    if (bound.structure.output_of[static_cast<std::size_t>(planar.y)] == k) kind[i] = 1;
    if (bound.structure.output_of[static_cast<std::size_t>(planar.heading)] == k) kind[i] = 2;
    (kind[i] == 2 ? sequence.tape_heading : sequence.tape_position)(static_cast<Eigen::Index>(i),
                                                                    static_cast<Eigen::Index>(i)) = 1;
  }
  for (Eigen::Index step = 1; step <= last; ++step) {
    const double x = trajectory.states(planar.x, last) - trajectory.states(planar.x, step);
    const double y = trajectory.states(planar.y, last) - trajectory.states(planar.y, step);
    Eigen::VectorXd turn = Eigen::VectorXd::Zero(count);  // of the end, for a turn in this step
    for (Eigen::Index i = 0; i < count; ++i) {
      const int what = kind[static_cast<std::size_t>(i)];
      turn[i] = what == 0 ? -y : what == 1 ? x : what == 2 ? 1 : 0;
      if (what == 0 || what == 1) sequence.by_position(i, i) += 1;
    }
    add_outer_product(sequence.by_heading, turn);
  }
  return sequence;
}

/// For the logarithms of the four variances.
SUREFOOT_ONCE Eigen::MatrixXd covariance_of(const FinalResiduals& s, const Eigen::VectorXd& logarithms) {
  const Eigen::VectorXd v = exponentials(logarithms);
  Eigen::MatrixXd sum(s.by_position.rows(), s.by_position.cols());
  for (Eigen::Index j = 0; j < sum.cols(); ++j) {
    for (Eigen::Index i = 0; i < sum.rows(); ++i) {
      sum(i, j) = v[0] * s.by_position(i, j) + v[1] * s.by_heading(i, j) + v[2] * s.tape_position(i, j) +
                  v[3] * s.tape_heading(i, j);
    }
  }
  return sum;
}

/// log |c| + off^T c^-1 off, for a covariance c.
SUREFOOT_ONCE double deviance(const Eigen::MatrixXd& c, const Eigen::VectorXd& off) {
  const auto factor = surefoot::detail::factorise_with_pivots(c);
  Eigen::VectorXd solved = off, diagonal(off.size());
  surefoot::detail::solve_factorised(factor, solved);
  constexpr double least = 1e-30;  // of D, whose logarithm is taken
  for (Eigen::Index k = 0; k < off.size(); ++k) diagonal[k] = std::max(factor.lower(k, k), least);
  return logarithms(diagonal).sum() + surefoot::detail::dot(off.data(), solved.data(), off.size());
}

/// Logarithms of the four variances with the highest likelihood, by a coordinate search.
SUREFOOT_ONCE Eigen::VectorXd most_likely_variances(const std::vector<FinalResiduals>& sequences,
                                                    const std::vector<std::size_t>& recordings) {
  const auto cost = [&](const Eigen::VectorXd& logarithms) {
    double sum = 0;
    for (const std::size_t r : recordings) {
      const FinalResiduals& s = sequences[r];
      if (s.off.size() > 0 && all_finite(s.off)) sum += deviance(covariance_of(s, logarithms), s.off);
    }
    return sum;
  };
  // A step is off by about 1 cm and 20 mrad, the tape by 1 cm and 30 mrad.
  Eigen::VectorXd best(4);
  best[0] = best[2] = 2 * std::log(0.01);
  best[1] = 2 * std::log(0.02);
  best[3] = 2 * std::log(0.03);
  constexpr double lowest = -20, highest = 4;  // of a logarithm
  double least = cost(best);
  for (double width = 2; width > 0.1; width *= 0.7) {
    for (int k = 0; k < 4; ++k) {
      for (const double move : {-width, width}) {
        Eigen::VectorXd next = best;
        next[k] = std::clamp(next[k] + move, lowest, highest);
        const double value = cost(next);
        if (value < least) {
          least = value;
          best = next;
        }
      }
    }
  }
  return best;
}

SUREFOOT_ONCE std::vector<Eigen::MatrixXd> final_pose_whitening(const BoundSimulator& bound,
                                                                const Hypothesis& hypothesis,
                                                                const std::vector<std::size_t>& recordings,
                                                                const Integration& integration) {
  std::vector<FinalResiduals> sequences;
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    sequences.push_back(final_residuals(bound, r, simulate(bound, hypothesis, r, integration)));
  }
  const Eigen::VectorXd best = most_likely_variances(sequences, recordings);
  std::vector<Eigen::MatrixXd> whitening(bound.recordings.size());
  for (std::size_t r = 0; r < sequences.size(); ++r) {
    const auto count = sequences[r].off.size();
    if (count == 0) continue;
    Eigen::MatrixXd factor = covariance_of(sequences[r], best);
    surefoot::detail::factorise_in_place(factor);
    whitening[r] = surefoot::detail::identity(count, count);
    surefoot::detail::solve_lower(factor, whitening[r]);
  }
  return whitening;
}

}  // namespace surefoot::diagnosis
