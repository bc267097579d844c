// A level limit: what rises above `level` is lost. Form "spill": `share` of it arrives in another state. Form "weir":
// it rises above its edge, over which flows outflow ((x - level) / level)^(3/2) (H. Chanson: "The hydraulics of open
// channel flow", 2004, chapter 19).
// Confusable with a clipped sensor or a limited input, which also cut the top off.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/extremes.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

// Levels are sought far down: the largest one may be a beginning that is not known, well above the brim.
[[gnu::cold]] inline Effect overflow() {
  return {.name = "overflow",
          .sentence = "{at} overflows at {level}",
          .place = Place::state,
          .parameters = parameters_of({{.name = "level",
                                        .measure = {.value = 1},
                                        .low = 0.1,
                                        .high = 4,
                                        .starts = {0.35, 0.5, 0.7, 0.85, 0.95},
                                        .of_peak = true}}),
          .confusable_with = names_of({"saturation", "leak"}),
          .experiment = "fill it well beyond the suspected level, slowly and quickly, and let it fall again",
          .needs_conserved_state = true,
          .suggest = near_largest,
          .limit = +[](Values p, double& value, double&, double&) {
            if (value > p[0]) value = p[0];
          }};
}

[[gnu::cold]] inline Effect overflow_spill() {
  Effect effect = overflow();
  effect.sentence = "{at} overflows at {level}, and a share of {share} of what is lost arrives elsewhere";
  effect.parameters.push_back({.name = "share", .measure = {}, .low = 0, .high = 2, .starts = {0.8}});
  effect.experiment = "fill it well beyond the suspected level, slowly and quickly, and watch where it goes";
  effect.form = "spill";
  effect.has_overflow_target = true;
  effect.limit = +[](Values p, double& value, double&, double& other) {
    if (value <= p[0]) return;
    other += p[1] * (value - p[0]);
    value = p[0];
  };
  return effect;
}

[[gnu::cold]] inline Effect overflow_weir() {
  Effect effect = overflow();
  effect.sentence = "{at} overflows at {level} as over a weir, by {outflow} at twice that height";
  effect.parameters[0].low = 0.01;  // the edge may be far below the level that is reached above it
  effect.parameters.push_back(
      {.name = "outflow", .measure = {.effort = 1}, .low = 0.3, .high = 3e4, .starts = {30, 300}});
  effect.form = "weir";
  effect.extends = {""};
  effect.suggest = {};
  effect.limit = {};
  effect.force = +[](const EffectContext& m, Values p, Values) {
    const double above = std::max(m.value / p[0] - 1, 0.0);
    return -p[1] * above * std::sqrt(above);
  };
  return effect;
}

}  // namespace surefoot::effects
