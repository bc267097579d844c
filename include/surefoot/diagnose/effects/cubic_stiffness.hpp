// A spring that hardens (or, negative, softens) away from position 0: force = -stiffness * q^3. Form "off center": away
// from another position, force = -stiffness * (q - center)^3, as where a sensor reads zero elsewhere than the spring is
// at rest. Form "coupling": a force that the equations have between two bodies grows with its cube, force + hardening *
// force^3. G. Duffing: "Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz", 1918. Confusable with a linear
// spring of the model at one amplitude, and with a soft end stop.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect cubic_stiffness() {
  return {
      .name = "cubic_stiffness",
      .sentence = "a spring that hardens with the cube of the position, {stiffness}, at {at}",
      .place = Place::velocity,
      .parameters = parameters_of({{.name = "stiffness",
                                    .measure = {.effort = 1, .position = -3},
                                    .low = -3,
                                    .high = 3,
                                    .starts = {0.003, 0.1},
                                    .strength = true}}),
      .confusable_with = names_of({"end_stop", "gravity_offset", "saturation"}),
      .experiment = "free oscillations, or slow sweeps, at a small and at the largest amplitude",
      .force = +[](const EffectContext& m, Values p, Values) { return -p[0] * m.position * m.position * m.position; }};
}

[[gnu::cold]] inline Effect cubic_stiffness_off_center() {
  Effect effect = cubic_stiffness();
  effect.sentence = "a spring that hardens with the cube of the position from {center} on, {stiffness}, at {at}";
  effect.parameters.push_back(
      {.name = "center", .measure = {.position = 1}, .low = -1, .high = 1, .starts = {-0.1, 0.1}});
  effect.form = "off center";
  effect.extends = {""};
  effect.force = +[](const EffectContext& m, Values p, Values) {
    const double from_center = m.position - p[1];
    return -p[0] * from_center * from_center * from_center;
  };
  return effect;
}

[[gnu::cold]] inline Effect cubic_stiffness_coupling() {
  return {.name = "cubic_stiffness",
          .sentence = "{at} hardens: {hardening} times its cube is added to it",
          .place = Place::input,
          .parameters = parameters_of({{.name = "hardening",
                                        .measure = {.value = -2},
                                        .low = -0.1,
                                        .high = 3,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"backlash", "joint_elasticity"}),
          .experiment = "free oscillations, or slow sweeps, at a small and at the largest amplitude",
          .form = "coupling",
          .needs_coupling = true,
          .signal = +[](const EffectContext& m, Values p, Values) { return m.value * (1 + p[0] * m.value * m.value); }};
}

}  // namespace surefoot::effects
