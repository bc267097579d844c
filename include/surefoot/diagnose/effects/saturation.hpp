// A limit of the input: u clipped to +-level. Form "soft": level * tanh(u/level). Form "gradual": a knee of any
// sharpness, u / (1 + |u/level|^sharpness)^(1/sharpness); 1 bends from the start, 3 is about tanh, 8 nearly clips.
// H. K. Khalil: "Nonlinear systems", 2002, section 1.2.6.
// Confusable with a lower gain when the input is always large, and with a supply that sags under load.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

// Starts in shares of the largest input; a soft limit already acts well below its level.
inline EffectParameter saturation_level(std::vector<double> starts) {
  return {
      .name = "level", .measure = {.value = 1}, .low = 0.05, .high = 6, .starts = std::move(starts), .of_peak = true};
}

[[gnu::cold]] inline Effect saturation() {
  return {.name = "saturation",
          .sentence = "{at} is limited to {level} either way",
          .place = Place::input,
          .parameters = {saturation_level({0.4, 0.6, 0.8, 0.93})},
          .confusable_with = names_of({"input_gain", "supply_sag", "rate_limit", "slip_saturation"}),
          .experiment = "steps of the input of growing size, up to the largest",
          .signal = +[](const EffectContext& m, Values p, Values) { return std::clamp(m.value, -p[0], p[0]); }};
}

[[gnu::cold]] inline Effect saturation_soft() {
  return {.name = "saturation",
          .sentence = "{at} levels off at {level} either way",
          .place = Place::input,
          .parameters = {saturation_level({0.5, 0.8, 1.3, 2.5})},
          .confusable_with = names_of({"input_gain", "supply_sag", "slip_saturation"}),
          .experiment = "steps of the input of growing size, up to the largest",
          .form = "soft",
          .signal = +[](const EffectContext& m, Values p, Values) { return p[0] * std::tanh(m.value / p[0]); }};
}

[[gnu::cold]] inline Effect saturation_gradual() {
  Effect effect = saturation_soft();
  effect.sentence = "{at} levels off at {level} either way, with a knee of sharpness {sharpness}";
  effect.parameters.push_back({.name = "sharpness", .low = 0.5, .high = 8, .starts = {1}});
  effect.form = "gradual";
  effect.signal = +[](const EffectContext& m, Values p, Values) {
    return m.value / std::pow(1 + std::pow(std::abs(m.value / p[0]), p[1]), 1 / p[1]);
  };
  return effect;
}

}  // namespace surefoot::effects
