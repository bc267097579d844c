// Definitions of surefoot/solve/rfpi_options.hpp.
#pragma once

#include <algorithm>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/solve/rfpi_options.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const LookaheadOptions& l) {
  auto require = [](bool good, const char* what) {
    if (!good) throw SolveError(std::string("RfpiOptions: ") + what);
  };
  require(l.candidates >= 1 && l.samples >= 1, "lookahead.candidates and lookahead.samples must be at least 1");
  require(l.refined >= 0, "lookahead.refined must not be negative");
  require(l.refined == 0 || (l.refined_samples >= 1 && l.kept >= 1),
          "lookahead.kept and lookahead.refined_samples must be at least 1");
  require(l.hold >= 1, "lookahead.hold must be at least 1");
  require(l.follow >= 0, "lookahead.follow must not be negative");
  require(l.softness >= 0 && l.step >= 0 && l.radius >= 0,
          "lookahead.softness, lookahead.step and lookahead.radius must not be negative");
}

SUREFOOT_ONCE void check(const RfpiOptions& o) {
  auto require = [](bool good, const char* what) {
    if (!good) throw SolveError(std::string("RfpiOptions: ") + what);
  };
  auto share = [](double x) { return x >= 0 && x <= 1; };
  require(o.budget.counted_seconds > 0, "budget.counted_seconds must be positive");
  require(o.max_seconds > 0, "max_seconds must be positive");
  require(o.budget.step_ns >= 0, "budget.step_ns must not be negative");
  require(o.discount >= 0 && o.discount <= 1, "discount must be in (0, 1], or 0 for 1 - 1 / horizon");
  require(o.horizon >= 1, "horizon must be at least 1");
  require(o.max_iterations >= 0, "max_iterations must be at least 1, or 0 for no limit");
  require(o.first_states >= 1 && o.max_states >= o.first_states,
          "first_states must be at least 1 and at most max_states");
  require(o.growth >= 1, "growth must be at least 1");
  require(o.initial_iterations >= 1, "initial_iterations must be at least 1: the first policy comes from one");
  require(share(o.box_share) && share(o.visited_share) && share(o.exploration) && share(o.backup_weight),
          "box_share, visited_share, exploration and backup_weight must be in [0, 1]");
  require(o.backup_steps >= 0 && o.backup_runs >= 1 && o.value_runs >= 1,
          "backup_steps must not be negative; backup_runs and value_runs must be at least 1");
  check(o.lookahead);
  require(o.evaluation_runs >= 2 || o.evaluation_runs == 0, "evaluation_runs must be at least 2, or 0");
  require(o.agreement > 0, "agreement must be positive");
  require(!o.resume || !o.checkpoint.empty(), "resume needs the name of the checkpoint file");
  try {
    check(o.value_forest);
    check(o.policy_forest);
  } catch (const ForestError& error) {
    require(false, error.what());
  }
}

SUREFOOT_INLINE RfpiOptions resolved(RfpiOptions options) {
  constexpr double least_discount = 0.9;  // of runs of less than ten transitions
  if (options.discount == 0) options.discount = std::max(least_discount, 1 - 1.0 / options.horizon);
  return options;
}

SUREFOOT_INLINE std::string explain(RfpiStop stop) {
  switch (stop) {
    case RfpiStop::budget:
      return "the budget is used up";
    case RfpiStop::iterations:
      return "all iterations are done";
    case RfpiStop::wall_clock:
      return "the wall clock ended it early, so the result depends on the speed of this machine";
    case RfpiStop::requested:
      return "it was asked to stop";
  }
  return {};
}

}  // namespace surefoot
