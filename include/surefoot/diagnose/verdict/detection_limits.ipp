// Definitions of surefoot/diagnose/verdict/detection_limits.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/verdict/detection_limits.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<DetectionLimit> detection_limits(const BoundSimulator& bound,
                                                           const std::vector<Proposal>& proposals) {
  std::vector<DetectionLimit> limits;
  for (const Proposal& proposal : proposals) {
    const std::vector<Eigen::Index> strengths = strengths_of(*proposal.effect.effect);
    if (strengths.empty() || !(proposal.visible > 0)) continue;
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
