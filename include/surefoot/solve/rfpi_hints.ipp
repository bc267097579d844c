// Definitions of surefoot/solve/rfpi_hints.hpp.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/solve/rfpi_hints.hpp"

namespace surefoot {

SUREFOOT_INLINE std::vector<std::string> hints(const LearningSigns& signs, const RfpiOptions& options,
                                               const HintCriteria& criteria) {
  const auto text = [](double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.4g", number);
    return std::string(digits);
  };
  std::vector<std::string> found;
  const double ahead = options.discount < 1 ? 1 / (1 - options.discount) : options.horizon;
  if (signs.least_reward == signs.greatest_reward && signs.ended_share == 0) {
    found.push_back(
        "every transition of the runs gave the same reward, " + text(signs.least_reward) +
        ", and none ended: nothing tells a good action from a bad one. Reward progress, let some runs start "
        "near the goal, hand over seed_states, or make the horizon (" +
        std::to_string(options.horizon) + ") longer");
  } else if (signs.random_cost - signs.learnt_cost < criteria.no_gain * std::abs(signs.random_cost)) {
    found.push_back(
        "the policy costs " + text(signs.learnt_cost) + ", random actions " + text(signs.random_cost) +
        ": nothing was learnt yet. Make the horizon (" + std::to_string(options.horizon) +
        ") longer if nothing can be reached within it, multiply budget.counted_seconds by five, or let some "
        "runs start where more can be gained");
  }
  if (ahead < criteria.short_sight * signs.mean_length) {
    found.push_back("runs last " + text(signs.mean_length) + " transitions, but with a discount of " +
                    text(options.discount) + " what is more than " + text(ahead) +
                    " of them away hardly counts: set discount to " + text(1 - 1 / signs.mean_length) +
                    ", or to 0 for one that fits the horizon");
  }
  if (signs.outside_share > criteria.outside) {
    found.push_back(text(100 * signs.outside_share) +
                    " % of the states that the policy leads to are outside state_box(), where nothing is learnt: make "
                    "it as large as states normally get");
  }
  return found;
}

}  // namespace surefoot
