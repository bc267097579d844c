// Definitions of surefoot/diagnose/selection/choose_holds.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"

namespace surefoot::diagnosis {

/// Whether two ways of integrating differ by more than what is lost in the residuals.
SUREFOOT_ONCE bool differ(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                          const Integration& other, const Parallel& parallel) {
  const Eigen::VectorXd& size = problem.weighting.sigma;
  const auto now = simulate_all(bound, hypothesis, problem.recordings, problem.integration, parallel);
  const auto then = simulate_all(bound, hypothesis, problem.recordings, other, parallel);
  const Eigen::VectorXd off = differences_of_runs(then, now, size.size());
  bool any = false;
  for (Eigen::Index k = 0; k < off.size(); ++k) any = any || off[k] > lost_in_residuals * size[k];
  return any;
}

/// Whether an input moves from most rows to the next: a command that stands still is not interpolated.
SUREFOOT_ONCE bool moves(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, std::size_t input) {
  const auto i = static_cast<Eigen::Index>(input);
  Eigen::Index moving = 0, rows = 0;
  for (const std::size_t r : recordings) {
    const Eigen::MatrixXd& inputs = bound.recordings[r].inputs;
    for (Eigen::Index row = 1; row < inputs.cols(); ++row) moving += inputs(i, row) != inputs(i, row - 1) ? 1 : 0;
    rows += inputs.cols() - 1;
  }
  return 2 * moving > rows;
}

SUREFOOT_ONCE std::vector<std::size_t> undeclared_inputs(const SimulatorInfo& info) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < info.inputs.size(); ++i) {
    if (!info.inputs[i].hold.has_value()) result.push_back(i);
  }
  return result;
}

SUREFOOT_ONCE bool is_smooth(InputHold hold) { return hold == InputHold::linear || hold == InputHold::band_limited; }

/// Inputs that go from row to row, by the model or as was found.
SUREFOOT_ONCE std::vector<std::size_t> smooth_inputs(const SimulatorInfo& info, const std::vector<InputHold>& found) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < info.inputs.size(); ++i) {
    const bool declared_so = info.inputs[i].hold == InputHold::band_limited;
    if (is_smooth(hold_of(info, found, i)) && !declared_so) result.push_back(i);
  }
  return result;
}

/// Some inputs in whichever of these ways predicts recordings best. True if that is another one than before.
SUREFOOT_ONCE bool choose_hold_of(const BoundSimulator& bound, const std::vector<std::size_t>& some,
                                  const std::vector<InputHold>& ways, Fit& fitted, SearchProblem& problem,
                                  const Parallel& parallel) {
  const auto evaluate = [&](const Fit& one, const FitProblem& with) {
    return EvaluatedHypothesis{
        one.hypothesis, one.loss,
        error_squares(bound, one.hypothesis, with.recordings, with.integration, problem.scale, parallel)};
  };
  const FitProblem before = problem.fit;
  const Fit now = fitted;
  double most = std::log(problem.criteria.named_odds);
  bool changed = false;
  for (const InputHold hold : ways) {
    if (problem.stopped()) return changed;
    FitProblem other = before;
    std::vector<InputHold>& inputs = other.integration.inputs;
    inputs.resize(bound.info.inputs.size(), InputHold::zero_order);
    bool otherwise = false, moving = true;
    for (const std::size_t i : some) {
      otherwise = otherwise || hold_of(bound.info, inputs, i) != hold;
      moving = moving && moves(bound, before.recordings, i);
      inputs[i] = hold;
    }
    if (!otherwise || (is_smooth(hold) && !moving)) continue;
    if (!differ(bound, now.hypothesis, before, other.integration, parallel)) continue;
    const Fit then = fit(bound, now.hypothesis, other, parallel);
    if (!then.ok) continue;
    const double odds = log_odds(evaluate(then, other), evaluate(now, before), problem.criteria);
    if (!(odds > most)) continue;
    most = odds;
    problem.fit.integration = other.integration;
    fitted = then;
    changed = true;
  }
  return changed;
}

SUREFOOT_ONCE bool choose_holds(const BoundSimulator& bound, Fit& fitted, SearchProblem& problem,
                                const Parallel& parallel) {
  using enum InputHold;
  if (bound.info.kind == SimulatorKind::map || few_readings(bound, problem.fit.recordings)) return false;
  bool changed = false;
  const auto choose_together = [&](const std::vector<std::size_t>& inputs, const std::vector<InputHold>& ways) {
    changed = choose_hold_of(bound, inputs, ways, fitted, problem, parallel) || changed;
  };
  const auto choose = [&](const std::vector<std::size_t>& inputs, const std::vector<InputHold>& ways) {
    for (const std::size_t i : inputs) choose_together({i}, ways);
    // what comes late in one may be hidden by what comes late in another
    if (inputs.size() > 1) choose_together(inputs, ways);
  };
  choose(undeclared_inputs(bound.info), {zero_order, linear, before});
  choose(smooth_inputs(bound.info, problem.fit.integration.inputs), {linear, band_limited});
  return changed;
}

}  // namespace surefoot::diagnosis
