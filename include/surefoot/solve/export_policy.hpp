// A policy as C for a controller: its forest, and the bounds of its actions.
#pragma once

#include <cmath>
#include <string>

#include "surefoot/forest/export_c.hpp"
#include "surefoot/solve/forest_policy.hpp"

namespace surefoot {

/// One C99 file with `void FUNCTION(const double in[], double out[])`: `in` are the features of the state (the state
/// itself where the problem has no `features`; else the robot computes them as that member does), `out` is the action
/// inside the action box, the policy's to the last bit: the vote of its trees included, which the C file of its forest
/// alone does not have. `options.low`, `options.high` and `options.agreement` are set here. Throws as export_c does.
template <Problem P>
std::string export_c(const ForestPolicy<P>& policy, ExportCOptions options = {}) {
  const auto box = policy.problem().action_box();
  options.low.assign(box.low().begin(), box.low().end());
  options.high.assign(box.high().begin(), box.high().end());
  if (std::isfinite(policy.agreement())) {
    const Vec<P::action_dim> reach = 0.5 * policy.agreement() * box.width();
    options.agreement.assign(reach.begin(), reach.end());
  }
  return export_c(policy.forest(), options);
}

}  // namespace surefoot
