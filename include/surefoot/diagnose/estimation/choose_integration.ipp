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

namespace surefoot::diagnosis {

/// The median interval of the recording that has the shortest.
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

SUREFOOT_ONCE Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const Eigen::VectorXd& residual_size, const Integration& now,
                                             const std::vector<std::size_t>& recordings, const Parallel& parallel) {
  constexpr double reference_steps = 8;  // per row, of what is held to be exact
  // Steps are a little longer than one, and a little shorter than a half or a quarter of a row, so that rounding does
  // not add one.
  constexpr double one_step = 1.5, two_steps = 1.9, four_steps = 3.9;
  if (bound.info.kind == SimulatorKind::map) return now;
  const double row = shortest_interval(bound, recordings);
  Integration fine = now;
  fine.order = 4;
  fine.step = row / reference_steps;
  const std::vector<SimulatedRun> exact = simulate_all(bound, hypothesis, recordings, fine, parallel);
  bool any_finite = false;
  for (const SimulatedRun& run : exact) any_finite = any_finite || run.finite;
  if (!any_finite) return fine;
  for (const auto& [order, step] :
       {std::pair{2, one_step * row}, {4, one_step * row}, {4, row / two_steps}, {4, row / four_steps}}) {
    Integration coarse = now;
    coarse.order = order;
    coarse.step = step;
    const auto runs = simulate_all(bound, hypothesis, recordings, coarse, parallel);
    const Eigen::VectorXd off = differences_of_runs(runs, exact, residual_size.size());
    bool good = true;
    for (Eigen::Index k = 0; k < off.size(); ++k) good = good && off[k] < lost_in_residuals * residual_size[k];
    if (good) return coarse;
  }
  return fine;
}

SUREFOOT_ONCE std::optional<Integration> finer_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                           const Eigen::VectorXd& residual_size,
                                                           const Integration& now,
                                                           const std::vector<std::size_t>& recordings,
                                                           const Parallel& parallel) {
  const Integration chosen = choose_integration(bound, hypothesis, residual_size, now, recordings, parallel);
  if (chosen.order <= now.order && chosen.step >= now.step) return std::nullopt;
  return chosen;
}

}  // namespace surefoot::diagnosis
