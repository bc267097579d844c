// Definitions of surefoot/diagnose/verdict/detection_limits.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/verdict/detection_limits.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE bool can_be_seen(const Proposal& proposal) {
  constexpr double most = 10;  // times the size at which it was sought, which is that of the motions that were recorded
  return proposal.visible > 0 && proposal.visible < most;
}

/// Whether a proposal is of the same effect and place, and in the plain form, or visible at a smaller multiple of its
/// size.
SUREFOOT_ONCE bool says_it_better(const Proposal& one, const Proposal& other) {
  const Effect &effect = *one.effect.effect, &same = *other.effect.effect;
  if (effect.name != same.name || one.effect.place != other.effect.place || !can_be_seen(one)) return false;
  if (effect.form.empty() != same.form.empty()) return effect.form.empty();
  return one.visible < other.visible || (one.visible == other.visible && &one < &other);
}

SUREFOOT_ONCE std::vector<DetectionLimit> detection_limits(const BoundSimulator& bound,
                                                           const std::vector<Proposal>& proposals) {
  std::vector<DetectionLimit> limits;
  for (const Proposal& proposal : proposals) {
    const std::vector<Eigen::Index> strengths = strengths_of(*proposal.effect.effect);
    if (strengths.empty() || !can_be_seen(proposal)) continue;
    bool is_best = true;
    for (const Proposal& other : proposals) is_best = is_best && !says_it_better(other, proposal);
    if (!is_best) continue;
    const Eigen::Index k = strengths.front();
    const EffectParameter& parameter = proposal.effect.effect->parameters[static_cast<std::size_t>(k)];
    limits.push_back({proposal.effect.effect->name,
                      proposal.effect.place,
                      {parameter.name, measure_unit(bound, proposal.effect, parameter.measure),
                       std::abs(proposal.visible) * proposal.tried[k], 0, 0}});
  }
  sort_items(limits, [](const DetectionLimit& a, const DetectionLimit& b) { return a.name < b.name; });
  return limits;
}

}  // namespace surefoot::diagnosis
