// Definitions of surefoot/diagnose/estimation/choose_integration.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const Eigen::VectorXd& residual_size, const Integration& now,
                                             std::size_t recording) {
  constexpr double error_share = 0.05;   // of the residuals that an integration may add: lost in them
  constexpr double reference_steps = 8;  // per row, of what is held to be exact
  // Steps are a little longer than one, and a little shorter than a half or a quarter of a row, so that rounding does
  // not add one.
  constexpr double one_step = 1.5, two_steps = 1.9, four_steps = 3.9;
  if (bound.info.kind == SimulatorKind::map) return now;
  const Recording& example = bound.recordings[recording];
  std::vector<double> intervals;
  for (Eigen::Index i = 1; i < example.rows(); ++i) intervals.push_back(example.time[i] - example.time[i - 1]);
  std::nth_element(intervals.begin(), intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2),
                   intervals.end());
  const double row = intervals[intervals.size() / 2];
  Integration fine = now;
  fine.order = 4;
  fine.step = row / reference_steps;
  const SimulatedRun exact = simulate(bound, hypothesis, recording, fine);
  if (!exact.finite) return fine;
  for (const auto& [order, step] :
       {std::pair{2, one_step * row}, {4, one_step * row}, {4, row / two_steps}, {4, row / four_steps}}) {
    Integration coarse = now;
    coarse.order = order;
    coarse.step = step;
    const SimulatedRun trajectory = simulate(bound, hypothesis, recording, coarse);
    if (!trajectory.finite) continue;
    bool good = true;
    for (Eigen::Index k = 0; k < residual_size.size(); ++k) {
      Eigen::VectorXd off(exact.outputs.cols());
      for (Eigen::Index row = 0; row < off.size(); ++row) off[row] = trajectory.outputs(k, row) - exact.outputs(k, row);
      const double error = root_mean_square(off);
      good = good && error < error_share * residual_size[k];
    }
    if (good) return coarse;
  }
  return fine;
}

SUREFOOT_ONCE std::optional<Integration> finer_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                           const Eigen::VectorXd& residual_size,
                                                           const Integration& now, std::size_t recording) {
  const Integration chosen = choose_integration(bound, hypothesis, residual_size, now, recording);
  if (chosen.order <= now.order && chosen.step >= now.step) return std::nullopt;
  return chosen;
}

}  // namespace surefoot::diagnosis
