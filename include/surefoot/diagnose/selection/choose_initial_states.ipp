// Definitions of surefoot/diagnose/selection/choose_initial_states.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/selection/choose_initial_states.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE void set_initial_scale(BoundSimulator& bound, std::size_t state, double scale) {
  for (Recording& recording : bound.recordings) recording.initial_scale[static_cast<Eigen::Index>(state)] = scale;
}

/// Log odds of a fit with more states free in each recording against one without.
SUREFOOT_ONCE double odds_of_freeing(const BoundSimulator& bound, const Fit& free, const Fit& known,
                                     const SearchProblem& problem, const Parallel& parallel, double states = 1) {
  const auto evaluate = [&](const Fit& one) {
    return EvaluatedHypothesis{
        one.hypothesis, one.loss,
        error_squares(bound, one.hypothesis, problem.fit.recordings, problem.fit.integration, problem.scale, parallel)};
  };
  const EvaluatedHypothesis with = evaluate(free), without = evaluate(known);
  return log_odds(with, without, problem.criteria) - states * cost_of_own_numbers(with.errors);
}

/// Fits with one state free, first alone; not ok if that does not help.
SUREFOOT_ONCE Fit fit_with_free(BoundSimulator& bound, std::size_t state, const Fit& known,
                                const SearchProblem& problem, const Parallel& parallel) {
  set_initial_scale(bound, state, bound.sizes.state[state]);
  FitProblem alone = problem.fit;
  alone.free = Free::initial_only;
  const Fit first = fit(bound, known.hypothesis, alone, parallel);
  if (!first.ok || !(odds_of_freeing(bound, first, known, problem, parallel) > 0)) return {};
  return fit(bound, first.hypothesis, problem.fit, parallel);
}

/// Whether a state is said to be known and is not read.
SUREFOOT_ONCE bool may_be_freed(const BoundSimulator& bound, std::size_t state) {
  const auto said = [&](const Recording& one) { return one.initial_scale[static_cast<Eigen::Index>(state)] == 0; };
  const bool measured = bound.structure.output_of[state] >= 0;  // a reading says where it begins
  return !measured && bound.sizes.state[state] > 0 && holds_for_all(bound.recordings, said);
}

/// Whether recordings can tell where their states begin: they begin once, and have more than a few readings.
SUREFOOT_ONCE bool tell_beginnings(const BoundSimulator& bound, const FitProblem& problem) {
  return bound.info.kind != SimulatorKind::map && !(problem.integration.restart > 0) &&
         !few_readings(bound, problem.recordings);
}

SUREFOOT_ONCE FreedTogether free_together(BoundSimulator bound, const Fit& known, const SearchProblem& problem,
                                          std::size_t starts, std::uint64_t seed, const Parallel& parallel) {
  FreedTogether result{std::vector<bool>(bound.info.states.size(), false)};
  if (!tell_beginnings(bound, problem.fit)) return result;
  int count = 0;
  for (std::size_t i = 0; i < result.states.size(); ++i) {
    if (!may_be_freed(bound, i)) continue;
    result.states[i] = true;
    set_initial_scale(bound, i, bound.sizes.state[i]);
    ++count;
  }
  if (count == 0) return result;
  FitProblem free = problem.fit;
  result.fitted = calibrate(bound, known.hypothesis, free, starts, seed, parallel);
  if (result.fitted.ok) result.log_odds = odds_of_freeing(bound, result.fitted, known, problem, parallel, count);
  return result;
}

SUREFOOT_ONCE std::vector<bool> free_initial_states(BoundSimulator& bound, Fit& fitted, const SearchProblem& problem,
                                                    const Parallel& parallel) {
  const std::size_t states = bound.info.states.size();
  std::vector<bool> freed(states, false);
  if (!tell_beginnings(bound, problem.fit)) return freed;
  while (!problem.stopped()) {
    double most = std::log(problem.criteria.named_odds);
    std::size_t best = states;
    Fit with;
    for (std::size_t i = 0; i < states && !problem.stopped(); ++i) {
      if (!may_be_freed(bound, i)) continue;
      const Fit one = fit_with_free(bound, i, fitted, problem, parallel);
      set_initial_scale(bound, i, 0);
      if (!one.ok) continue;
      const double odds = odds_of_freeing(bound, one, fitted, problem, parallel);
      if (!(odds > most)) continue;
      most = odds;
      best = i;
      with = one;
    }
    if (best == states) break;
    freed[best] = true;
    set_initial_scale(bound, best, bound.sizes.state[best]);
    fitted = with;
  }
  return freed;
}

SUREFOOT_ONCE void restore_initial_states(BoundSimulator& bound, std::vector<bool>& freed, Fit& fitted,
                                          const SearchProblem& problem, const Parallel& parallel) {
  for (std::size_t i = 0; i < freed.size() && !problem.stopped(); ++i) {
    if (!freed[i]) continue;
    const auto state = static_cast<Eigen::Index>(i);
    const double scale = bound.recordings.front().initial_scale[state];
    set_initial_scale(bound, i, 0);
    Hypothesis start = fitted.hypothesis;
    for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
      start.initial[r][state] = bound.recordings[r].initial[state];
    }
    const Fit known = fit(bound, start, problem.fit, parallel);
    const bool needed =
        !known.ok || odds_of_freeing(bound, fitted, known, problem, parallel) > std::log(problem.criteria.named_odds);
    if (needed) {
      set_initial_scale(bound, i, scale);
    } else {
      freed[i] = false;
      fitted = known;
    }
  }
}

}  // namespace surefoot::diagnosis
