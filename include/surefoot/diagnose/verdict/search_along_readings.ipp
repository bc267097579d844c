// Definitions of surefoot/diagnose/verdict/search_along_readings.hpp.
#pragma once

#include <algorithm>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/instability.hpp"
#include "surefoot/diagnose/verdict/search_along_readings.hpp"
#include "surefoot/diagnose/verdict/search_stage.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE bool search_along_readings(EstimationSetup& setup, const RunContext& run, FoundModel& model) {
  constexpr int most_effects = 2;  // beside others, predictions over so few rows show little of one
  DiagnoseOptions options = run.options;
  options.max_effects = std::min(options.max_effects, most_effects);
  options.max_seconds = std::min(options.max_seconds, 2 * run.seconds() / search_share);
  const RunContext part{options, run.parallel, run.seed, run.stop, run.began};
  setup.bound.integration.follow = guided_follow(setup.bound, setup.problem, guided_horizons.front());
  Diagnosis aside;
  const Searched found = search_effects(setup, part, aside);
  const Hypothesis& chosen = found.selection.chosen.hypothesis;
  if (part.search_has_ended() || chosen.effects.size() == found.problem.known) return false;
  if (found.problem.structured(chosen, found.selection.fit)) return false;
  model.hypothesis = chosen;
  model.sizes = setup.bound.sizes;
  setup.bound.integration.follow = 0;
  model.follow = needed_follow(setup.bound, chosen, run.parallel);
  return true;
}

}  // namespace surefoot::diagnosis
