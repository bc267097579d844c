// Definitions of surefoot/diagnose/estimation/choose_integration.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/estimation/items.hpp"

namespace surefoot::diagnosis {

/// Steps of what is held to be exact, for each that it takes to run at all; and the most of a row that are tried for
/// that.
inline constexpr double reference_steps = 8, most_steps = 128;

SUREFOOT_ONCE double shortest_interval(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const std::size_t r : recordings) {
    const Recording& one = bound.recordings[r];
    std::vector<double> intervals;
    for (Eigen::Index i = 1; i < one.rows(); ++i) intervals.push_back(one.time[i] - one.time[i - 1]);
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::nth_element(intervals.begin(), middle, intervals.end());
    shortest = std::min(shortest, *middle);
  }
  return shortest;
}

SUREFOOT_ONCE Eigen::VectorXd differences_of_runs(const std::vector<SimulatedRun>& runs,
                                                  const std::vector<SimulatedRun>& exact, Eigen::Index outputs) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(outputs);
  double rows = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (!exact[i].finite) continue;
    if (!runs[i].finite) return Eigen::VectorXd::Constant(outputs, std::numeric_limits<double>::infinity());
    for (Eigen::Index row = 0; row < exact[i].outputs.cols(); ++row) {
      for (Eigen::Index k = 0; k < outputs; ++k) {
        const double off = runs[i].outputs(k, row) - exact[i].outputs(k, row);
        squares[k] += off * off;
      }
    }
    rows += static_cast<double>(exact[i].outputs.cols());
  }
  for (double& value : squares) value = std::sqrt(value / std::max(rows, 1.0));
  return squares;
}

SUREFOOT_ONCE bool any_is_finite(const std::vector<SimulatedRun>& runs) {
  return holds_for_any(runs, [](const SimulatedRun& run) { return run.finite; });
}

/// Slack of a step, so that rounding does not add one.
inline constexpr double step_slack = 0.1;  // of a step

/// Largest absolute value of any state.
SUREFOOT_ONCE double largest_state(const SimulatedRun& run) {
  double largest = 0;
  for (Eigen::Index i = 0; i < run.states.size(); ++i) largest = std::max(largest, std::abs(run.states.data()[i]));
  return largest;
}

/// Runs that end, and that do not go far beyond what they do in finer steps: an integrator that is unstable may well
/// stay finite.
SUREFOOT_ONCE std::ptrdiff_t count_stable(const std::vector<SimulatedRun>& runs,
                                          const std::vector<SimulatedRun>& finer) {
  constexpr double far = 100;  // times as large: no error of an integrator that follows the motion
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool runs_away = finer[i].finite && largest_state(runs[i]) > far * largest_state(finer[i]);
    if (runs[i].finite && !runs_away) ++count;
  }
  return count;
}

/// `now` with as few steps of a row as it takes to simulate as many of these recordings as can be; as it is where that
/// is none.
SUREFOOT_ONCE Integration coarsest_that_runs(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const Integration& now, double row,
                                             const std::vector<std::size_t>& recordings, const Parallel& parallel) {
  const auto in_steps = [&](double steps) {
    Integration integration = now;
    integration.step = steps > 1 ? row / (steps - step_slack) : 0;
    return integration;
  };
  Integration best = now;
  std::ptrdiff_t most = 0;
  std::vector<SimulatedRun> finer = simulate_all(bound, hypothesis, recordings, in_steps(1), parallel);
  for (double steps = 1; steps <= most_steps; steps *= 2) {
    const std::vector<SimulatedRun> runs = std::move(finer);
    finer = simulate_all(bound, hypothesis, recordings, in_steps(2 * steps), parallel);
    const std::ptrdiff_t stable = count_stable(runs, finer);
    if (stable > most) best = in_steps(steps);
    most = std::max(most, stable);
    if (most == static_cast<std::ptrdiff_t>(recordings.size())) break;
  }
  return best;
}

SUREFOOT_ONCE Integration integration_that_runs(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                const Parallel& parallel) {
  if (bound.info.kind == SimulatorKind::map) return bound.integration;
  const std::vector<std::size_t> all = all_recordings(bound);
  return coarsest_that_runs(bound, hypothesis, bound.integration, shortest_interval(bound, all), all, parallel);
}

SUREFOOT_ONCE bool below(const Eigen::VectorXd& off, double share, const Eigen::VectorXd& residual_size) {
  for (Eigen::Index k = 0; k < off.size(); ++k) {
    if (!(off[k] < share * residual_size[k])) return false;
  }
  return true;
}

SUREFOOT_ONCE ChosenIntegration choose_integrations(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                    const Eigen::VectorXd& residual_size, const Integration& now,
                                                    const std::vector<std::size_t>& recordings,
                                                    const Parallel& parallel) {
  constexpr double one_step = 1.5;  // a little longer than a row, so that rounding does not add one
  if (bound.info.kind == SimulatorKind::map) return {now, now};
  const double row = shortest_interval(bound, recordings);
  Integration fine = now;
  fine.order = 4;
  const Integration runs = coarsest_that_runs(bound, hypothesis, fine, row, recordings, parallel);
  fine.step = (runs.step > 0 ? std::min(row, runs.step) : row) / reference_steps;
  const std::vector<SimulatedRun> exact = simulate_all(bound, hypothesis, recordings, fine, parallel);
  if (!any_is_finite(exact)) return {fine, fine};
  std::vector<std::pair<int, double>> coarser{{2, one_step * row}, {4, one_step * row}};
  for (double more = 2; row / more > 1.5 * fine.step; more *= 2) coarser.emplace_back(4, row / (more - step_slack));
  std::optional<Integration> screening;
  for (const auto& [order, step] : coarser) {
    Integration coarse = now;
    coarse.order = order;
    coarse.step = step;
    const auto tried = simulate_all(bound, hypothesis, recordings, coarse, parallel);
    const Eigen::VectorXd off = differences_of_runs(tried, exact, residual_size.size());
    if (!screening && below(off, lost_in_screening, residual_size)) screening = coarse;
    if (below(off, lost_in_residuals, residual_size)) return {coarse, *screening};
  }
  return {fine, screening.value_or(fine)};
}

SUREFOOT_ONCE Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const Eigen::VectorXd& residual_size, const Integration& now,
                                             const std::vector<std::size_t>& recordings, const Parallel& parallel) {
  return choose_integrations(bound, hypothesis, residual_size, now, recordings, parallel).fitting;
}

SUREFOOT_ONCE bool is_finer(const Integration& one, const Integration& other) {
  return one.order > other.order || one.step < other.step;
}

SUREFOOT_ONCE std::optional<Integration> finer_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                           const Eigen::VectorXd& residual_size,
                                                           const Integration& now,
                                                           const std::vector<std::size_t>& recordings,
                                                           const Parallel& parallel) {
  const Integration chosen = choose_integration(bound, hypothesis, residual_size, now, recordings, parallel);
  return is_finer(chosen, now) ? std::optional(chosen) : std::nullopt;
}

}  // namespace surefoot::diagnosis
